# Repeated-measures ANOVA from its definition in matrices; afex must agree wherever it can.

orthonormal <- function(k) contr.helmert(k) %*% diag(1 / sqrt(colSums(contr.helmert(k)^2)), k - 1)

# the contrasts of an effect in the space of all cells, the first factor running slowest
contrasts_of <- function(levels, inside) {
  Reduce(kronecker, lapply(seq_along(levels), function(i) {
    k <- levels[i]
    if (i %in% inside) orthonormal(k) else matrix(1 / sqrt(k), k, 1)
  }))
}

# y: people × cells, the first factor running slowest; `levels`: how many each factor has
anova_rows <- function(y, factors) {
  levels <- lengths(factors)
  names <- names(factors)
  n <- nrow(y)
  z <- y - y[, 1] # exact, and no within-person contrast knows of it
  effects <- unlist(lapply(seq_along(levels), function(m) combn(seq_along(levels), m, simplify = FALSE)), recursive = FALSE)
  parts <- lapply(effects, function(inside) {
    scores <- z %*% contrasts_of(levels, inside)
    middle <- colMeans(scores)
    list(scores = scores, ss = n * sum(middle^2), error = sum(sweep(scores, 2, middle)^2))
  })
  own <- rowMeans(y - y[1, 1])
  people <- ncol(y) * sum((own - mean(own))^2)
  residual <- people + sum(sapply(parts, function(p) p$error))
  rows <- lapply(seq_along(effects), function(i) {
    name <- paste(names[effects[[i]]], collapse = " × ")
    c(list(effect = name), effect_row(parts[[i]], n, residual, max(abs(y))))
  })
  check_afex(y, factors, rows)
  rows
}

effect_row <- function(part, n, residual, scale) {
  q <- ncol(part$scores)
  df1 <- q
  df2 <- q * (n - 1)
  gone <- c(
    "F", "p", "eps", "p_gg", "eps_hf", "p_hf", "p_lower", "mauchly_w", "mauchly_p", "ges", "pes", "pes_low", "pes_high",
    "bf10", "negligible_p"
  )
  out <- c(list(n = n, df1 = df1, df2 = df2), setNames(rep(list(undefined), length(gone)), gone))
  out$ss_effect <- part$ss
  out$ss_error <- part$error
  if (n > 1 && part$ss + residual > 0) out$ges <- part$ss / (part$ss + residual)
  if (n < 2 || all(apply(part$scores, 2, is_noise, scale = scale))) return(out)
  f <- (part$ss / df1) / (part$error / df2)
  s <- cov(part$scores)
  eps <- if (q == 1) 1 else sum(diag(s))^2 / (q * sum(s^2))
  out$F <- f
  out$p <- pf(f, df1, df2, lower.tail = FALSE)
  out$eps <- eps
  out$p_gg <- pf(f, df1 * eps, df2 * eps, lower.tail = FALSE)
  # Huynh and Feldt as Lecoutre corrected it (car has the same), at most 1
  hf <- if (q == 1) 1 else min(1, (n * q * eps - 2) / (q * (n - 1 - q * eps)))
  if (q == 1 || n - 1 > q * eps) {
    out$eps_hf <- hf
    out$p_hf <- pf(f, df1 * hf, df2 * hf, lower.tail = FALSE)
  }
  out$p_lower <- pf(f, 1, n - 1, lower.tail = FALSE)
  if (q > 1 && n - 1 >= q) {
    box <- mauchly_box(s, n - 1)
    out$mauchly_w <- box[1]
    out$mauchly_p <- box[2]
  }
  out$pes <- part$ss / (part$ss + part$error)
  ends <- pes_interval(f, df1, df2)
  out$pes_low <- ends[1]
  out$pes_high <- ends[2]
  out$bf10 <- bf_jzs(f, df1, n)
  out$negligible_p <- p_noncentral_f(f, df1, df2, df2 * 0.06 / (1 - 0.06))
  out
}

# Mauchly's W of q contrasts' covariance, and Box's p to the second order (Anderson 1958, 10.7.3:
# q contrasts; R's mauchly.test puts the number of cells into the second term)
mauchly_box <- function(s, df) {
  q <- ncol(s)
  w <- det(s) / (sum(diag(s)) / q)^q
  rho <- 1 - (2 * q^2 + q + 2) / (6 * q * df)
  omega <- (q + 2) * (q - 1) * (q - 2) * (2 * q^3 + 6 * q^2 + 3 * q + 2) / (288 * (df * q * rho)^2)
  x <- -df * rho * log(w)
  f <- q * (q + 1) / 2 - 1
  p1 <- pchisq(x, f, lower.tail = FALSE)
  p2 <- pchisq(x, f + 4, lower.tail = FALSE)
  c(w, min(1, max(0, p1 + omega * (p2 - p1))))
}

# afex (car) on the same cells: F, df, p, generalised eta squared, epsilon
check_afex <- function(y, factors, rows) {
  if (nrow(y) - 1 <= ncol(y) || any(sapply(rows, function(r) is.na(r$F)))) return(invisible())
  grid <- do.call(expand.grid, rev(lapply(factors, as.character)))[, length(factors):1, drop = FALSE]
  names(grid) <- names(factors)
  long <- data.frame(
    who = factor(rep(seq_len(nrow(y)), ncol(y))),
    value = as.vector((y - y[1, 1]) / sd(y - y[1, 1])),
    grid[rep(seq_len(ncol(y)), each = nrow(y)), , drop = FALSE]
  )
  fit <- suppressMessages(suppressWarnings(afex::aov_ez(
    "who", "value", long,
    within = names(factors), anova_table = list(correction = "none", es = c("ges", "pes"))
  )))
  table <- as.data.frame(fit$anova_table)
  univariate <- suppressWarnings(summary(fit))
  eps <- univariate$pval.adjustments
  for (row in rows) {
    name <- gsub(" × ", ":", row$effect)
    theirs <- table[name, ]
    ours <- c(row$df1, row$df2, row$F, row$ges, row$pes)
    # sums of squares of cells keep about ten digits beside a large one
    stopifnot(all(abs(ours / unlist(theirs[c("num Df", "den Df", "F", "ges", "pes")]) - 1) < 1e-7))
    if (row$df1 > 1) {
      stopifnot(abs(eps[name, "GG eps"] / row$eps - 1) < 1e-7)
      stopifnot(abs(min(1, eps[name, "HF eps"]) / row$eps_hf - 1) < 1e-7)
    }
  }
}
