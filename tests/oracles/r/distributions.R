# Noncentral distributions by integration, and what is inverted from them.

# The mean of a smooth function of V / df, V chi-squared: over its root, which has no pole, in
# pieces between its quantiles. What lies outside them is less than 1e-17.
over_chisq <- function(inside, df) {
  low <- c(1e-18, 1e-9, 1e-4, 0.05, 0.5)
  cuts <- sqrt(c(qchisq(low, df), qchisq(rev(low[-5]), df, lower.tail = FALSE)))
  f <- function(s) inside(s^2 / df) * 2 * s * dchisq(s^2, df)
  pieces <- mapply(function(a, b) {
    integrate(f, a, b, rel.tol = 1e-10, abs.tol = 1e-15)$value
  }, head(cuts, -1), cuts[-1])
  sum(pieces)
}

p_noncentral_t <- function(t, df, nc) over_chisq(function(v) pnorm(t * sqrt(v) - nc), df)

p_noncentral_f <- function(f, df1, df2, nc) {
  if (df1 == 1) {
    root <- sqrt(f)
    return(p_noncentral_t(root, df2, sqrt(nc)) - p_noncentral_t(-root, df2, sqrt(nc)))
  }
  over_chisq(function(v) pchisq(f * df1 * v, df1, ncp = nc), df2)
}

root_of <- function(f, low, high) {
  uniroot(f, c(low, high), tol = 1e-13 * max(1, abs(high)), extendInt = "downX", maxiter = 500)$root
}

# the noncentralities that put t at the two tails
nct_interval <- function(t, df, level) {
  reach <- 4 + abs(t) * 0.8
  sapply(c((1 + level) / 2, (1 - level) / 2), function(tail) {
    root_of(function(nc) p_noncentral_t(t, df, nc) - tail, t - reach, t + reach)
  })
}

# the same for F: zero where even the central distribution has less than the tail below it
ncf_interval <- function(f, df1, df2, level) {
  sapply(c((1 + level) / 2, (1 - level) / 2), function(tail) {
    g <- function(nc) p_noncentral_f(f, df1, df2, nc) - tail
    if (g(0) <= 0) return(0)
    root_of(g, 0, max(10, 2 * f * df1))
  })
}

# JZS: H1 has a Cauchy of this scale on the standardised effect, by g ~ inverse chi-squared(1)
SCALE <- sqrt(1 / 2)

bf_jzs <- function(f, df1, n, scale = SCALE) {
  # log of likelihood ratio given g, times g's density, on log g
  h <- function(x) {
    spread <- 1 + n * scale^2 * exp(x)
    -df1 / 2 * log(spread) -
      df1 * n / 2 * (log1p(f / (n - 1) / spread) - log1p(f / (n - 1))) -
      log(2 * pi) / 2 - x / 2 - exp(-x) / 2
  }
  top <- optimize(h, c(-10, 60), maximum = TRUE, tol = 1e-10)
  g <- function(x) exp(h(x) - top$objective)
  cuts <- c(-12, top$maximum + c(-6, -2, 0, 2, 6, 20), 150)
  cuts <- sort(unique(pmin(pmax(cuts, -12), 150)))
  area <- sum(mapply(function(a, b) integrate(g, a, b, rel.tol = 1e-11)$value, head(cuts, -1), cuts[-1]))
  log_bf <- top$objective + log(area)
  if (log_bf > 700) return(NA)
  exp(log_bf)
}
