# The report's tables, section by section, from trials and answers. Each is a list of rows.

two_levels <- function(trials) identical(levels_in(trials$transparency, LEVELS), LEVELS)

task_factors <- function(rows) {
  list(task = levels_in(rows$task, TASKS), transparency = levels_in(rows$transparency, LEVELS))
}

# people × task × transparency; `column` averaged over the trials of a cell
by_task <- function(rows, who, column, f = mean) table_of(rows, who, column, task_factors(rows), f)

spread_row <- function(v, log_v = NULL) {
  names <- c("mean", "sd", "low", "high", "geometric", "median", "minimum", "maximum")
  if (!length(v)) return(setNames(rep(list(undefined), length(names)), names))
  half <- if (length(v) > 1) qt(0.975, length(v) - 1) * sd0(v) / sqrt(length(v)) else undefined
  geometric <- if (is.null(log_v)) undefined else exp(mean(log_v))
  list(
    mean = mean(v), sd = if (length(v) > 1) sd0(v) else undefined,
    low = if (length(v) > 1) mean(v) - half else undefined,
    high = if (length(v) > 1) mean(v) + half else undefined, geometric = geometric,
    median = median(v), minimum = min(v), maximum = max(v)
  )
}

# each task × transparency cell over those who have it
cell_rows <- function(cells, logs = NULL) {
  rows <- list()
  for (task in cells$factors$task) {
    for (level in cells$factors$transparency) {
      v <- cells$values[, task, level]
      there <- !is.na(v)
      rows <- c(rows, list(c(
        list(cell = paste0(task, "/", level), n = sum(there), trials = sum(cells$counts[there, task, level])),
        spread_row(unname(v[there]), if (!is.null(logs)) unname(logs$values[there, task, level]))
      )))
    }
  }
  rows
}

# the measures of a people × task × transparency table: overall, then each task
task_measures <- function(cells, prefix, overall, family, kind) {
  tasks <- cells$factors$task
  found <- list()
  if (length(tasks) > 1) {
    middle <- apply(cells$values, c(1, 3), mean) # NA unless all are there
    found <- list(of_cells(middle, 1, paste0(prefix, "_", overall), "", kind))
  }
  own <- lapply(seq_along(tasks), function(i) {
    of_cells(cells$values, i, paste0(prefix, "_", tasks[i]), family, kind)
  })
  keep(c(found, own))
}

# cells as people × cells, the first factor running slowest, of who has them all
complete_matrix <- function(values) {
  d <- dim(values)
  kept <- whole(values)
  out <- matrix(aperm(values, c(1, rev(seq_along(d)[-1]))), nrow = d[1])
  out[kept, , drop = FALSE]
}

anova_of <- function(cells) {
  y <- complete_matrix(cells$values)
  if (!nrow(y) || min(lengths(cells$factors)) < 2) return(NULL)
  anova_rows(y, cells$factors)
}

# people × scenario × transparency: the mean over the tasks nested in a scenario
by_scenario <- function(cells, rows) {
  scenario <- sapply(cells$factors$task, function(t) rows$scenario[match(t, rows$task)])
  there <- levels_in(scenario, SCENARIOS)
  values <- array(NA, c(dim(cells$values)[1], length(there), dim(cells$values)[3]))
  for (i in seq_along(there)) {
    values[, i, ] <- apply(cells$values[, scenario == there[i], , drop = FALSE], c(1, 3), mean)
  }
  list(values = values, factors = list(scenario = there, transparency = cells$factors$transparency))
}

time_tables <- function(d) {
  d$rows$log_time <- log(d$rows$time)
  cells <- by_task(d$rows, d$who, "time")
  logs <- by_task(d$rows, d$who, "log_time")
  out <- list(time_cells = cell_rows(cells, logs))
  if (!two_levels(d$rows)) return(out)
  out$tests_time <- compare(task_measures(cells, "time", "overall", "tasks", "time"), d$margins)
  measures <- task_measures(logs, "time", "overall", "tasks", "time")
  out$tests_log_time <- holm(
    lapply(measures, log_row, margins = d$margins), sapply(measures, function(m) m$family)
  )
  out$anova_time_task <- anova_of(cells)
  out$anova_time_task_log <- anova_of(logs)
  out$anova_time_scenario <- anova_of(by_scenario(cells, d$rows))
  out$anova_time_scenario_log <- anova_of(by_scenario(logs, d$rows))
  out
}

# |Σ answer − Σ truth| / Σ truth over the trials of a cell; or Σ |answer − truth| / Σ truth
relative_error <- function(rows, who, cancel) {
  rows <- rows[rows$task %in% c("count", "count_in_building") & !is.na(rows$count_error), ]
  rows$true_number <- as.numeric(rows$truth)
  rows$off <- if (cancel) rows$count_error else abs(rows$count_error)
  off <- by_task(rows, who, "off", sum)
  off$values <- abs(off$values) / by_task(rows, who, "true_number", sum)$values
  off
}

accuracy_tables <- function(d) {
  right <- by_task(d$rows, d$who, "correct")
  out <- list(correct_cells = cell_rows(right))
  for (cancel in c(TRUE, FALSE)) {
    name <- if (cancel) "count_error" else "absolute_error"
    if (!any(!is.na(d$rows$count_error))) next
    cells <- relative_error(d$rows, d$who, cancel)
    out[[paste0(name, "_cells")]] <- cell_rows(cells)
    if (!two_levels(d$rows)) next
    measures <- task_measures(cells, name, "overall", "counting", "count_error")
    out[[paste0("tests_", name)]] <- compare(measures, d$margins)
    out[[paste0("anova_", name, "_task")]] <- anova_of(cells)
    # only one of the two scenarios holds the task: there is no factor to test
    out[[paste0("anova_", name, "_scenario")]] <- anova_of(by_scenario(cells, d$rows))
  }
  marks <- d$rows[d$rows$task == "unique", ]
  if (nrow(marks)) {
    place <- by_task(marks, d$who, "distance")
    out$distance_cells <- cell_rows(place)
    if (two_levels(d$rows)) {
      far <- of_cells(place$values, 1, "distance_unique", "", "distance")
      out$tests_distance <- compare(keep(list(far)), d$margins)
    }
  }
  if (!two_levels(d$rows)) return(out)
  tasks <- right$factors$task
  shares <- keep(lapply(seq_along(tasks), function(i) {
    of_cells(right$values, i, paste0("correct_", tasks[i]), "tasks", "correct")
  }))
  rows <- lapply(shares, friedman_of, margins = d$margins)
  out$friedman_correct <- holm(rows, sapply(shares, function(m) m$family), "p_exact")
  out
}

ITEMS <- c("efficiency", "ease", "enjoy")

ratings_tables <- function(d) {
  q <- d$questions
  out <- list(single_items = single_items(q))
  q <- q[q$item %in% ITEMS & !is.na(q$value), ]
  out$reliability <- reliability_rows(q, sort(unique(d$questions$participant), method = "radix"))
  if (!two_levels(q)) return(out)
  factors <- list(
    item = levels_in(q$item, ITEMS), scenario = levels_in(q$scenario, SCENARIOS), transparency = LEVELS
  )
  cells <- table_of(q, sort(unique(d$questions$participant), method = "radix"), "value", factors)
  v <- cells$values
  overall <- of_cells(apply(v, c(1, 4), mean), 1, "rating_overall", "", "rating")
  each <- list()
  for (s in seq_along(factors$scenario)) {
    for (i in seq_along(factors$item)) {
      key <- paste0(factors$item[i], "_", factors$scenario[s])
      each <- c(each, list(of_cells(v[, i, s, ], 1, key, "ratings", "rating")))
    }
  }
  measures <- keep(c(list(overall), each))
  rows <- lapply(measures, friedman_of, margins = d$margins)
  out$friedman_ratings <- holm(rows, sapply(measures, function(m) m$family), "p_exact")
  if (length(factors$scenario) < 2) return(out)
  y <- complete_matrix(aperm(apply(v, c(1, 3, 4), mean), c(1, 3, 2)))
  if (nrow(y) < 2) return(out)
  test <- friedman_row(y)
  out$friedman_conditions <- list(c(list(measure = "rating_conditions"), test))
  if (is.na(test$chi2)) return(out)
  names <- as.vector(t(outer(LEVELS, factors$scenario, paste)))
  out$post_hoc_conditions <- pairs_after(y, names)
  out
}

# Cronbach's alpha with Feldt's interval (psych), and omega of one factor (factanal), by condition.
reliability_rows <- function(q, who) {
  rows <- list()
  if (!all(ITEMS %in% q$item)) return(rows)
  for (t in levels_in(q$transparency, LEVELS)) for (s in levels_in(q$scenario, SCENARIOS)) {
    own <- q[q$transparency == t & q$scenario == s, ]
    if (!nrow(own)) next
    x <- tapply(own$value, list(factor(own$participant, who), factor(own$item, ITEMS)), mean)
    x <- x[rowSums(is.na(x)) == 0, , drop = FALSE]
    if (!nrow(x)) next
    row <- list(
      scale = paste("ratings", t, s, sep = "/"), items = ncol(x), n = nrow(x), alpha = undefined,
      low = undefined, high = undefined, omega = undefined
    )
    if (nrow(x) >= 3 && all(apply(x, 2, function(c) diff(range(c)) > 0)) && var(rowSums(x)) > 0) {
      a <- suppressMessages(suppressWarnings(psych::alpha(x, check.keys = FALSE, warnings = FALSE)))
      row$alpha <- a$total$raw_alpha
      row$low <- a$feldt$lower.ci[[1]]
      row$high <- a$feldt$upper.ci[[1]]
      row$omega <- omega_of(x)
    }
    rows <- c(rows, list(row))
  }
  rows
}

omega_of <- function(x) {
  r <- cor(x)
  k <- ncol(x)
  if (qr(r)$rank < k) return(undefined)
  # the likelihood itself, over loadings and uniquenesses, from many starts: factanal stops at improper
  # solutions, and may end in a shallow one; it finds none that is better
  loss <- function(theta) {
    sigma <- tcrossprod(theta[1:k]) + diag(theta[-(1:k)])
    as.numeric(determinant(sigma)$modulus) + sum(diag(solve(sigma, r)))
  }
  set.seed(1)
  fits <- lapply(1:20, function(i) {
    try(nlminb(c(runif(k, -0.9, 0.9), runif(k, 0.1, 0.9)), loss,
      lower = c(rep(-Inf, k), rep(0.005, k)), upper = c(rep(Inf, k), rep(1, k)),
      control = list(rel.tol = 1e-15, x.tol = 1e-12, eval.max = 2000, iter.max = 2000)
    ), silent = TRUE)
  })
  fits <- Filter(function(f) !inherits(f, "try-error"), fits)
  best <- fits[[which.min(sapply(fits, function(f) f$objective))]]$par
  load <- best[1:k]
  own <- best[-(1:k)]
  if (any(own <= 0.005 * (1 + 1e-4)) || sum(own < 0.99) < 3) return(undefined)
  theirs <- try(factanal(covmat = cov(x), n.obs = nrow(x), factors = 1), silent = TRUE)
  if (!inherits(theirs, "try-error")) stopifnot(loss(c(theirs$loadings[, 1], theirs$uniquenesses)) >= loss(best) - 1e-6)
  sum_of <- sum(load * apply(x, 2, sd))^2
  sum_of / (sum_of + sum(own * apply(x, 2, var)))
}

# A preference for neither is a tie: counted, and left out of share, interval and test.
single_items <- function(q) {
  rows <- lapply(c("preference", "depth_self_report", "depth_test"), function(item) {
    own <- q[q$item == item & !is.na(q$value), ]
    if (!nrow(own)) return(NULL)
    out <- list(
      item = item, n = nrow(own), neutral = "", mean = mean(own$value), sd = sd_or_none(own$value),
      low = "", high = "", p = ""
    )
    if (item != "preference") return(out)
    neither <- own$text == "neutral" | !own$value %in% c(0, 1)
    v <- own$value[!neither]
    out$neutral <- sum(neither)
    out[c("mean", "sd", "low", "high", "p")] <- undefined
    if (!length(v)) return(out)
    test <- binom.test(sum(v == 1), length(v))
    out$mean <- mean(v)
    out$sd <- sd_or_none(v)
    out$low <- test$conf.int[1]
    out$high <- test$conf.int[2]
    out$p <- test$p.value
    out
  })
  keep(rows)
}

sd_or_none <- function(v) if (length(v) > 1) sd(v) else undefined
