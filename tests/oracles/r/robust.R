# The contrasts without normality (every sign of every difference) and without outliers.

MOST_EXACT <- 18

robust_rows <- function(d) {
  if (!two_levels(d$rows)) return(NULL)
  d$rows$log_time <- log(d$rows$time)
  measures <- task_measures(by_task(d$rows, d$who, "log_time"), "time", "overall", "", "")
  if (any(!is.na(d$rows$count_error))) {
    measures <- c(
      measures,
      task_measures(relative_error(d$rows, d$who, TRUE), "count_error", "overall", "", ""),
      task_measures(relative_error(d$rows, d$who, FALSE), "absolute_error", "overall", "", "")
    )
  }
  marks <- d$rows[d$rows$task == "unique", ]
  if (nrow(marks)) {
    place <- by_task(marks, d$who, "distance")
    measures <- c(measures, keep(list(of_cells(place$values, 1, "distance_unique"))))
  }
  lapply(measures, function(m) robust_row(m$key, m$x, m$y))
}

robust_row <- function(key, x, y) {
  v <- x - y
  p_of <- function(v) {
    if (length(v) < 2 || is_noise(v, max(abs(c(x, y))))) undefined else t.test(v)$p.value
  }
  gap <- abs(v - median(v))
  # equal up to the rounding of what they are made from: 32 roundings of the largest
  same <- 1.4826 * median(gap) <= 32 * .Machine$double.eps * max(abs(c(x, y)))
  far <- if (same) rep(FALSE, length(v)) else gap > 3 * mad(v)
  list(
    measure = key, n = length(v), p = p_of(v), p_flip = flip_p(v), outliers = sum(far),
    p_without = p_of(v[!far])
  )
}

# all signs up to MOST_EXACT people; above, many draws, which the report's are held to
flip_p <- function(v) {
  n <- length(v)
  if (n < 2 || max(abs(v)) == 0 || (n < 3 && is_noise(v, max(abs(v))))) return(undefined)
  v <- v / max(abs(v))
  observed <- abs(sum(v)) - 1e-13
  if (n <= MOST_EXACT) {
    sums <- 0
    for (x in v) sums <- c(sums + x, sums - x)
    return(mean(abs(sums) >= observed))
  }
  set.seed(1)
  hits <- 0
  for (i in 1:20) hits <- hits + sum(abs((matrix(sample(c(-1, 1), 20000 * n, TRUE), ncol = n)) %*% v) >= observed)
  hits / 400000
}
