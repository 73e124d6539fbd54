# Friedman, signed ranks, sign test. Ranks are of exact numbers: what is equal as a fraction ties.

# Means are of a few whole numbers, or of decimals with few places: equal ones differ by rounding
# only, unequal ones by far more than this.
exact <- function(x, scale = max(abs(x))) if (scale == 0) x else round(x / scale, 9)

sign_p <- function(wins, losses) {
  if (wins + losses == 0) return(1)
  binom.test(wins, wins + losses)$p.value
}

friedman_row <- function(y) {
  n <- nrow(y)
  k <- ncol(y)
  y <- matrix(exact(y), n)
  out <- list(n = n, k = k, chi2 = undefined, df = k - 1, p = undefined, p_exact = undefined, method = "", w = undefined)
  if (n < 2 || all(y == y[, 1])) return(out)
  test <- friedman.test(y)
  out$chi2 <- unname(test$statistic)
  out$p <- test$p.value
  out$w <- out$chi2 / (n * (k - 1))
  r <- t(apply(y, 1, rank))
  if (k == 2) {
    out$p_exact <- sign_p(sum(r[, 1] > r[, 2]), sum(r[, 1] < r[, 2]))
    out$method <- "exact"
    return(out)
  }
  out$p_exact <- if (n <= 20) permutation_p(r) else sampled_p(r)
  out$method <- if (n <= 20) "enumerated" else "sampled"
  out
}

statistic_of <- function(sums, n, k) rowSums((sums - n * (k + 1) / 2)^2)

orders_of <- function(k) {
  every <- as.matrix(expand.grid(rep(list(seq_len(k)), k)))
  every[apply(every, 1, function(o) !anyDuplicated(o)), ]
}

# every way to give each person's ranks to the conditions, person by person
permutation_p <- function(r) {
  n <- nrow(r)
  k <- ncol(r)
  orders <- orders_of(k)
  base <- 2 * n * k + 1
  keys <- 0
  chances <- 1
  for (i in seq_len(n)) {
    half <- matrix(2 * r[i, ][orders], nrow(orders))[, -k, drop = FALSE]
    steps <- drop(half %*% base^(seq_len(k - 1) - 1))
    weights <- table(steps) / length(steps)
    new <- outer(keys, as.numeric(names(weights)), "+")
    share <- outer(chances, as.numeric(weights))
    code <- match(new, keys <- unique(as.vector(new)))
    chances <- as.vector(rowsum(as.vector(share), code, reorder = TRUE))
  }
  sums <- sapply(seq_len(k - 1), function(j) (keys %/% base^(j - 1)) %% base) / 2
  sums <- cbind(sums, n * k * (k + 1) / 2 - rowSums(sums))
  observed <- statistic_of(t(colSums(r)), n, k)
  sum(chances[statistic_of(sums, n, k) >= observed - 1e-9])
}

# too many ways: drawn, ten times as often as the report does
sampled_p <- function(r, draws = 200000) {
  n <- nrow(r)
  k <- ncol(r)
  set.seed(1)
  orders <- orders_of(k)
  sums <- matrix(0, draws, k)
  for (i in seq_len(n)) {
    sums <- sums + matrix(r[i, ][orders[sample.int(nrow(orders), draws, TRUE), ]], draws)
  }
  observed <- statistic_of(t(colSums(r)), n, k)
  (sum(statistic_of(sums, n, k) >= observed - 1e-9) + 1) / (draws + 1)
}

pairs_after <- function(y, names) {
  n <- nrow(y)
  k <- ncol(y)
  middle <- colMeans(t(apply(matrix(exact(y), n), 1, rank)))
  pairs <- combn(k, 2, simplify = FALSE)
  rows <- lapply(pairs, function(p) {
    gap <- middle[p[1]] - middle[p[2]]
    d <- exact(y[, p[1]] - y[, p[2]], max(abs(y)))
    out <- list(
      pair = paste(names[p], collapse = " – "),
      rank_difference = gap,
      nemenyi_p = ptukey(abs(gap) / sqrt(k * (k + 1) / (12 * n)), k, Inf, lower.tail = FALSE),
      v = undefined, p = undefined
    )
    if (all(d == 0)) return(out)
    r <- rank(abs(d[d != 0]))
    out$v <- sum(r[d[d != 0] > 0])
    out$p <- if (sum(d != 0) > 200) {
      2 * pnorm(-abs(out$v - sum(r) / 2) / sqrt(sum(r^2) / 4))
    } else {
      exactRankTests::wilcox.exact(d, exact = TRUE)$p.value
    }
    out
  })
  p <- sapply(rows, function(r) r$p)
  adjusted <- p.adjust(p, "holm", n = sum(!is.na(p)))
  for (i in seq_along(rows)) rows[[i]]$holm_p <- adjusted[i]
  rows
}
