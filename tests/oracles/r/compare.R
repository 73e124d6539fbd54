# Rows of the tables that set standard against dynamic.

# No difference as equality, and as no worse. Only margins that the study declared count.
MARGIN_NAMES <- c("tost_margin", "tost_p", "noninferior_p", "low90", "high90")

no_margin <- function() setNames(rep(list(undefined), length(MARGIN_NAMES)), MARGIN_NAMES)

equivalence <- function(x, y, kind, margins) {
  margin <- margins[[kind]]
  if (is.null(margin)) return(no_margin())
  if (kind == "time") return(ratio_within(x, y, margin))
  out <- no_margin()
  out$tost_margin <- margin
  d <- x - y
  if (is_noise(d, max(abs(c(x, y))))) return(out)
  above_lower <- t.test(d, mu = -margin, alternative = "greater")$p.value
  below_upper <- t.test(d, mu = margin, alternative = "less")$p.value
  out$tost_p <- max(above_lower, below_upper)
  # worse: more time or error with the technique, d below; fewer right answers, d above
  out$noninferior_p <- if (kind == "correct") below_upper else above_lower
  ends <- t.test(d, conf.level = 0.90)$conf.int
  out$low90 <- ends[1]
  out$high90 <- ends[2]
  out
}

# the ratio of means between 1/theta and theta: one-sided t of y − theta x and of y − x/theta
ratio_within <- function(x, y, theta) {
  out <- no_margin()
  out$tost_margin <- theta
  upper <- y - theta * x
  lower <- y - x / theta
  if (is_noise(upper, max(abs(c(y, theta * x)))) || is_noise(lower, max(abs(c(x, y))))) return(out)
  not_larger <- t.test(upper, alternative = "less")$p.value
  not_smaller <- t.test(lower, alternative = "greater")$p.value
  out$tost_p <- max(not_larger, not_smaller)
  out$noninferior_p <- not_larger
  ends <- fieller(x, y, 0.90)
  out$low90 <- ends[1]
  out$high90 <- ends[2]
  out
}

log_equivalence <- function(x, y, margins) {
  out <- no_margin()
  if (is.null(margins$time)) return(out)
  own <- equivalence(x, y, "absolute", list(absolute = log(margins$time)))
  own$tost_margin <- margins$time
  own[c("low90", "high90")] <- list(exp(-own$high90), exp(-own$low90))
  own
}

# differences of z scores have no ratio
no_ratio <- list(ratio = undefined, ratio_low = undefined, ratio_high = undefined)

compare_row <- function(m, margins) {
  c(
    list(measure = m$key),
    describe_two(m$x, m$y),
    f_of_two(m$x, m$y),
    difference_of_two(m$x, m$y),
    if (m$ratio) ratio_of_two(m$x, m$y) else no_ratio,
    equivalence(m$x, m$y, m$kind, margins)
  )
}

compare <- function(measures, margins) {
  holm(lapply(measures, compare_row, margins = margins), sapply(measures, function(m) m$family))
}

log_row <- function(m, margins) {
  own <- difference_of_two(m$x, m$y)
  c(
    list(
      measure = m$key, n = length(m$x),
      geometric_baseline = exp(mean(m$x)), geometric_level = exp(mean(m$y)),
      ratio = exp(-own$difference), ratio_low = exp(-own$difference_high),
      ratio_high = exp(-own$difference_low)
    ),
    f_of_two(m$x, m$y), own, log_equivalence(m$x, m$y, margins)
  )
}

friedman_of <- function(m, margins) {
  test <- friedman_row(cbind(m$x, m$y))
  c(
    list(measure = m$key),
    test,
    describe_two(m$x, m$y)[c("mean_baseline", "sd_baseline", "mean_level", "sd_level")],
    list(difference = mean(m$x - m$y)),
    equivalence(m$x, m$y, m$kind, margins)
  )
}

# A measure: its values under both levels, the family that Holm corrects within, what it measures
measure <- function(key, x, y, family = "", kind = "", ratio = TRUE) {
  list(key = key, x = x, y = y, family = family, kind = kind, ratio = ratio)
}

# the measure of one cell (index `at` into all but the last dimension) of those who have both
of_cells <- function(values, at, key, family = "", kind = "", ratio = TRUE) {
  two <- matrix(values, nrow = dim(values)[1])
  n_cells <- prod(dim(values)[-c(1, length(dim(values)))])
  x <- two[, at]
  y <- two[, n_cells + at]
  both <- !is.na(x) & !is.na(y)
  if (!any(both)) return(NULL)
  measure(key, unname(x[both]), unname(y[both]), family, kind, ratio)
}

keep <- function(measures) Filter(Negate(is.null), measures)
