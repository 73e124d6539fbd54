# Speed against accuracy, order, learning, faults, difficulty, single trials.

# Whether y grew from x, up to the rounding of means
step <- function(x, y) sign(ifelse(abs(y - x) <= 1e-12 * pmax(abs(x), abs(y)), 0, y - x))

tradeoff_tables <- function(d) {
  if (!two_levels(d$rows)) return(list())
  d$rows$log_time <- log(d$rows$time)
  cells <- by_task(d$rows, d$who, "log_time")
  rows <- lapply(cells$factors$task, function(task) tradeoff_row(d, cells, task))
  out <- list(tradeoff = keep(rows), conditional_accuracy = conditional(d$rows))
  out$tests_combined <- combined(d)
  out
}

own_error <- function(d, task) {
  rows <- d$rows[d$rows$task == task, ]
  if (task == "unique") return(table_of(rows, d$who, "distance", list(transparency = LEVELS))$values)
  if (task == "pattern") return(1 - table_of(rows, d$who, "correct", list(transparency = LEVELS))$values)
  matrix(relative_error(rows, d$who, FALSE)$values, ncol = 2)
}

tradeoff_row <- function(d, cells, task) {
  time <- cells$values[, task, ] # means of trials' logarithms
  error <- own_error(d, task)
  both <- rowSums(is.na(time)) + rowSums(is.na(error)) == 0
  if (!any(both)) return(NULL)
  time <- time[both, , drop = FALSE]
  error <- error[both, , drop = FALSE]
  faster <- step(time[, 1], time[, 2]) < 0
  worse <- step(error[, 1], error[, 2])
  out <- list(
    task = task, n = sum(both),
    faster_worse = sum(faster & worse > 0), faster_better = sum(faster & worse < 0),
    faster_same = sum(faster & worse == 0), slower = sum(!faster),
    p_errors = sign_p(sum(faster & worse > 0), sum(faster & worse < 0)),
    r = undefined, r_low = undefined, r_high = undefined, p = undefined
  )
  gain <- time[, 2] - time[, 1]
  change <- error[, 2] - error[, 1]
  if (sum(both) < 4 || all(worse == 0) || diff(range(change)) < 1e-12 * max(abs(error))) return(out)
  if (diff(range(gain)) <= 8 * .Machine$double.eps * max(abs(time))) return(out)
  test <- cor.test(gain, change)
  out$r <- unname(test$estimate)
  out$r_low <- test$conf.int[1]
  out$r_high <- test$conf.int[2]
  out$p <- test$p.value
  out
}

# thirds of the trials of a person's cell by speed; equal times have one rank, so one third
conditional <- function(rows) {
  rows <- rows[!is.na(rows$correct), ]
  cell <- paste(rows$participant, rows$task, rows$transparency)
  place <- ave(rows$time, cell, FUN = function(t) rank(t))
  size <- ave(rows$time, cell, FUN = length)
  part <- pmin(floor((place - 1) * 3 / size), 2)
  rows$part <- part
  rows <- rows[size >= 3, ]
  names <- c("fastest third", "middle third", "slowest third")
  out <- list()
  for (level in levels_in(rows$transparency, LEVELS)) {
    for (i in 0:2) {
      own <- rows$correct[rows$transparency == level & rows$part == i]
      if (length(own)) {
        out <- c(out, list(list(
          cell = paste0(level, "/", names[i + 1]), share = mean(own), trials = length(own)
        )))
      }
    }
  }
  out
}

# over all trials with an answer: shares right, mean times, and the three usual scores
combined <- function(d) {
  rows <- d$rows[!is.na(d$rows$correct), ]
  factor <- list(transparency = LEVELS)
  rows$one <- 1
  rows$right_time <- rows$time * rows$correct
  sums <- lapply(c("one", "time", "correct", "right_time"), function(column) {
    table_of(rows, d$who, column, factor, sum)$values
  })
  kept <- whole(sums[[1]])
  if (!any(kept)) return(NULL)
  sums <- lapply(sums, function(s) s[kept, , drop = FALSE])
  share <- sums[[3]] / sums[[1]]
  time <- sums[[2]] / sums[[1]]
  measures <- list()
  z <- function(v) (v - mean(v)) / sqrt(mean((v - mean(v))^2))
  varies <- function(v) diff(range(v)) > 1e-12 * max(abs(v))
  if (varies(share) && varies(time)) {
    bis <- z(share) - z(time - time[1])
    measures <- list(measure("bis", bis[, 1], bis[, 2], ratio = FALSE))
  }
  if (all(sums[[3]] > 0)) {
    ies <- sums[[4]] / sums[[3]] / share
    measures <- c(measures, list(measure("ies", ies[, 1], ies[, 2])))
  }
  rcs <- sums[[3]] / sums[[2]]
  compare(c(measures, list(measure("rcs", rcs[, 1], rcs[, 2]))), d$margins)
}

# one row for each condition as a person met it: the mean over tasks of mean log times
met <- function(rows) {
  rows$y <- log(rows$time)
  by_task <- aggregate(y ~ participant + session + block + transparency + scenario + task, rows, mean)
  found <- aggregate(y ~ participant + session + block + transparency + scenario, by_task, mean)
  found <- found[order(found$participant, found$session, found$block, method = "radix"), ]
  found$condition <- paste(found$transparency, found$scenario)
  before <- ave(seq_len(nrow(found)), found$participant, FUN = function(i) c(0, head(i, -1)))
  found$carry <- as.numeric(c("", found$transparency)[before + 1] == "dynamic")
  found
}

order_rows <- function(d) {
  rows <- met(d$rows)
  rows$y <- rows$y - rows$y[1]
  scale <- max(abs(log(d$rows$time)))
  # each term given the participants and all others
  terms <- c(period = "factor(block)", condition = "condition", `carry-over` = "carry")
  usable <- c(
    "participant",
    if (length(unique(rows$block)) > 1) terms["period"],
    if (length(unique(rows$condition)) > 1) terms["condition"],
    if (length(unique(rows$carry)) > 1) terms["carry-over"]
  )
  if (length(unique(rows$participant)) < 2) usable <- usable[-1]
  model <- function(parts) lm(reformulate(c("1", parts), "y"), rows)
  full <- model(usable)
  left <- sum(residuals(full)^2)
  df2 <- full$df.residual
  out <- lapply(c("period", "carry-over"), function(name) {
    rest <- model(setdiff(usable, terms[name]))
    df1 <- rest$df.residual - df2
    f_row(name, df1, df2, sum(residuals(rest)^2) - left, left, scale)
  })
  level <- tapply(rows$y, rows$participant, mean)
  sequence <- tapply(rows$condition, rows$participant, paste, collapse = " → ")
  k <- length(unique(sequence))
  n <- length(level)
  inside <- sum((level - ave(level, sequence))^2)
  f <- f_row("sequence", k - 1, n - k, sum((level - mean(level))^2) - inside, inside, scale)
  c(out, list(f))
}

f_row <- function(name, df1, df2, effect, error, scale) {
  out <- list(effect = name, df1 = df1, df2 = df2, F = undefined, p = undefined, negligible_p = undefined)
  if (df1 <= 0 || df2 <= 0 || error <= df2 * (8 * .Machine$double.eps * scale)^2) return(out)
  out$F <- max(0, effect / df1) / (error / df2)
  out$p <- pf(out$F, df1, df2, lower.tail = FALSE)
  out$negligible_p <- p_noncentral_f(out$F, df1, df2, df2 * 0.06 / (1 - 0.06))
  out
}

learning_tables <- function(d) {
  rows <- d$rows
  rows$y <- log(rows$time)
  sets <- split(rows, paste(rows$participant, rows$session, rows$task_set))
  sets <- Filter(function(s) length(unique(s$trial_in_set)) > 1, sets)
  if (!length(sets)) return(list())
  slope <- sapply(sets, function(s) coef(lm(y ~ trial_in_set, s))[["trial_in_set"]])
  own <- tapply(slope, sapply(sets, function(s) s$participant[1]), mean)
  test <- t.test(own)
  n <- length(own)
  row <- list(
    what = "per trial", n = n, ratio = exp(mean(own)), low = exp(test$conf.int[1]),
    high = exp(test$conf.int[2]), df = n - 1, t = unname(test$statistic), p = test$p.value
  )
  factors <- list(
    transparency = levels_in(rows$transparency, LEVELS), trial_in_set = sort(unique(rows$trial_in_set))
  )
  cells <- table_of(rows, d$who, "y", factors)
  curve <- list()
  for (i in seq_along(factors$transparency)) {
    for (j in seq_along(factors$trial_in_set)) {
      v <- cells$values[, i, j]
      if (any(!is.na(v))) {
        curve <- c(curve, list(list(
          cell = paste0(factors$transparency[i], "/", factors$trial_in_set[j]),
          position = factors$trial_in_set[j],
          time = exp(mean(v, na.rm = TRUE)), n = sum(!is.na(v))
        )))
      }
    }
  }
  list(learning = list(row), learning_curve = curve)
}

fault_rows <- function(d) {
  if (!two_levels(d$rows)) return(NULL)
  rows <- d$rows
  rows$lost <- as.numeric(rows$time_clean < rows$time)
  factor <- list(transparency = LEVELS)
  missed <- table_of(rows, d$who, "frames_missed", factor, sum)$values
  missed <- missed / table_of(rows, d$who, "frames", factor, sum)$values
  measures <- keep(list(
    if (!d$simulated) of_cells(missed, 1, "frames_missed"),
    of_cells(table_of(rows, d$who, "lost", factor)$values, 1, "focus_lost"),
    of_cells(table_of(rows, d$who, "timed_out", factor)$values, 1, "timed_out")
  ))
  compare(measures, d$margins)
}

QUANTITIES <- c("targets", "visible", "hidden", "occluders", "clutter", "path")

difficulty_rows <- function(d) {
  if (!two_levels(d$rows)) return(NULL)
  rows <- d$rows
  if (!is.null(d$certificate)) {
    at <- match(paste(rows$scene, rows$task), paste(d$certificate$scene, d$certificate$task))
    for (name in QUANTITIES[-1]) rows[[name]] <- d$certificate[[name]][at]
  }
  out <- list()
  for (quantity in intersect(QUANTITIES, names(rows))) {
    known <- rows[!is.na(rows[[quantity]]), ]
    cells <- by_task(known, d$who, quantity)
    for (i in seq_along(cells$factors$task)) {
      task <- cells$factors$task[i]
      m <- of_cells(cells$values, i, paste0(quantity, "_", task))
      if (is.null(m) || (quantity == "path" && all(m$x == 0) && all(m$y == 0))) next
      row <- compare_row(m, d$margins)
      row$low <- row$difference_low
      row$high <- row$difference_high
      row <- row[c(
        "measure", "n", "mean_baseline", "mean_level", "difference", "low", "high", "p"
      )]
      # the scenes of the people who are compared
      both <- d$who[!is.na(cells$values[, i, 1]) & !is.na(cells$values[, i, 2])]
      own <- known[known$task == task & known$participant %in% both, ]
      row$smd <- smd(own[[quantity]], own$transparency)
      out <- c(out, list(row))
    }
  }
  out
}

smd <- function(v, level) {
  a <- v[level == "standard"]
  b <- v[level == "dynamic"]
  if (min(length(a), length(b)) < 2) return(undefined)
  spread <- sqrt((var(a) + var(b)) / 2)
  if (spread == 0) return(undefined)
  (mean(b) - mean(a)) / spread
}
