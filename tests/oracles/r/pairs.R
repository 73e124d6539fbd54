# Two conditions: every column of the tables that compare them.

undefined <- NA # written as `undefined`
nothing <- NULL # written as an empty cell

# the spread of the differences is no more than the rounding of what they are made from
is_noise <- function(d, scale) length(d) < 2 || sd(d) <= 8 * .Machine$double.eps * scale

# less the first value, which is exact: variances do not know of it, and an offset costs no digit
shifted <- function(x, by = x[1]) x - by
sd0 <- function(x) sd(shifted(x))

f_of_two <- function(x, y) {
  n <- length(x)
  d <- x - y
  by <- x[1]
  a <- shifted(x, by)
  b <- shifted(y, by)
  ss_effect <- n * mean(d)^2 / 2
  ss_error <- sum((d - mean(d))^2) / 2
  ss_people <- if (n > 1) sum(((a + b) / 2 - mean((a + b) / 2))^2) * 2 else 0
  total <- ss_effect + ss_error + ss_people
  out <- list(df1 = 1, df2 = n - 1, F = undefined, p = undefined)
  out$ges <- if (n > 1 && total > 0) ss_effect / total else undefined
  out$pes <- out$pes_low <- out$pes_high <- undefined
  if (is_noise(d, max(abs(c(x, y))))) return(out)
  test <- t.test(d)
  f <- unname(test$statistic)^2
  out$F <- f
  out$p <- pf(f, 1, n - 1, lower.tail = FALSE)
  out$pes <- f / (f + n - 1)
  ends <- pes_interval(f, 1, n - 1)
  out$pes_low <- ends[1]
  out$pes_high <- ends[2]
  out
}

# 90 % interval of partial eta squared, only where it holds its estimate
pes_interval <- function(f, df1, df2) {
  ends <- ncf_interval(f, df1, df2, 0.90)
  ends <- ends / (ends + df2)
  if (ends[2] < f * df1 / (f * df1 + df2)) return(c(undefined, undefined))
  ends
}

difference_of_two <- function(x, y) {
  n <- length(x)
  d <- x - y
  names <- c(
    "difference_low", "difference_high", "sd_difference", "t", "dz", "dz_low", "dz_high", "bf10",
    "shapiro_w", "shapiro_p"
  )
  out <- c(list(difference = mean(d)), setNames(rep(list(undefined), length(names)), names))
  if (n > 1) out$sd_difference <- 0
  if (is_noise(d, max(abs(c(x, y))))) return(out)
  test <- t.test(d)
  t <- unname(test$statistic)
  out$difference_low <- test$conf.int[1]
  out$difference_high <- test$conf.int[2]
  out$sd_difference <- sd(d)
  out$t <- t
  out$dz <- mean(d) / sd(d)
  ends <- nct_interval(t, n - 1, 0.95) / sqrt(n)
  out$dz_low <- ends[1]
  out$dz_high <- ends[2]
  out$bf10 <- bf_jzs(t^2, 1, n)
  # R's own package, within its own error; for large t it approximates
  if (abs(t) < 10) {
    theirs <- BayesFactor::ttest.tstat(t = t, n1 = n, rscale = SCALE, simple = TRUE)
    stopifnot(abs(log(out$bf10) - log(unname(theirs))) < 1e-5)
  }
  if (n >= 3 && n <= 5000) {
    test <- shapiro.test(d)
    out$shapiro_w <- unname(test$statistic)
    out$shapiro_p <- test$p.value
  }
  out
}

# dynamic / standard: all ratios that a paired t test of y − ratio · x does not reject (Fieller)
fieller <- function(x, y, level) {
  n <- length(x)
  q <- qt((1 + level) / 2, n - 1)^2 / n
  a <- mean(x)^2 - q * var(shifted(x))
  b <- mean(x) * mean(y) - q * cov(shifted(x), shifted(y))
  c <- mean(y)^2 - q * var(shifted(y))
  if (a <= 0) return(c(undefined, undefined))
  root <- sqrt(max(0, b^2 - a * c))
  c((b - root) / a, (b + root) / a)
}

ratio_of_two <- function(x, y) {
  out <- list(ratio = undefined, ratio_low = undefined, ratio_high = undefined)
  if (mean(x) == 0) return(out)
  out$ratio <- mean(y) / mean(x)
  if (length(x) < 2) return(out)
  ends <- fieller(x, y, 0.95)
  out$ratio_low <- ends[1]
  out$ratio_high <- ends[2]
  out
}

describe_two <- function(x, y) {
  n <- length(x)
  sd_of <- function(v) if (n > 1) sd0(v) else undefined
  flat <- n > 1 && (diff(range(x)) == 0 || diff(range(y)) == 0)
  list(
    n = n,
    mean_baseline = mean(x), sd_baseline = sd_of(x),
    mean_level = mean(y), sd_level = sd_of(y),
    r = if (n < 2 || flat) undefined else cor(shifted(x), shifted(y)),
    within_half = within_half(x, y)
  )
}

# Cousineau's interval with Morey's factor: each value less its person's mean
within_half <- function(x, y) {
  n <- length(x)
  if (n < 2) return(undefined)
  own <- (x - y) / 2 # x less the mean of x and y
  qt(0.975, n - 1) * sd(own) * sqrt(2 / (2 - 1)) / sqrt(n)
}

# Holm within each family; a row of no family has no corrected p
holm <- function(rows, families, column = "p") {
  for (i in seq_along(rows)) {
    own <- if (families[i] == "") nothing else rows[[i]][[column]]
    rows[[i]]["p_holm"] <- list(own)
  }
  for (family in setdiff(unique(families), "")) {
    inside <- which(families == family)
    p <- sapply(rows[inside], function(r) r[[column]])
    adjusted <- p.adjust(p, "holm", n = sum(!is.na(p)))
    for (j in seq_along(inside)) rows[[inside[j]]]["p_holm"] <- list(adjusted[j])
  }
  rows
}
