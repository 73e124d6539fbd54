# Who took part, what was counted, who lacks what.

participants_tables <- function(d) {
  all <- d$recorded
  counted <- d$rows
  out <- list()
  out$totals <- lapply(list(
    c("participants", length(unique(all$participant))),
    c("trials recorded", nrow(all)),
    c("trials counted", nrow(counted)),
    c("trials excluded", sum(d$why != "")),
    c("questionnaire rows", nrow(d$questions))
  ), function(v) list(what = v[1], count = as.numeric(v[2])))
  factors <- task_factors(counted)
  grid <- expand.grid(transparency = factors$transparency, task = factors$task, stringsAsFactors = FALSE)
  out$trials_by_cell <- lapply(seq_len(nrow(grid)), function(i) {
    hit <- counted$task == grid$task[i] & counted$transparency == grid$transparency[i]
    list(cell = paste0(grid$task[i], "/", grid$transparency[i]), trials = sum(hit))
  })
  if (length(d$who) <= 200) {
    out$participants <- lapply(d$who, function(name) {
      own <- all[all$participant == name, ]
      list(
        participant = name, slot = own$slot[1], trials = nrow(own),
        counted = sum(counted$participant == name)
      )
    })
  }
  gone <- all[d$why != "", ]
  if (nrow(gone)) {
    out$excluded <- lapply(seq_len(nrow(gone)), function(i) {
      list(
        row_id = gone$row_id[i], participant = gone$participant[i], rule = d$why[d$why != ""][i],
        file = gone$file[i], row = gone$row[i]
      )
    })
  }
  out$files <- lapply(seq_len(nrow(d$files)), function(i) as.list(d$files[i, ]))
  out$missing <- missing_rows(d)
  if (length(d$who) > 1) out$smallest_effect <- list(smallest_effect(length(d$who), d$alpha))
  out
}

# the standardised difference that a two-sided paired t test finds in 80 % of studies, and the
# least p that a sign test can have
smallest_effect <- function(n, alpha) {
  critical <- qt(1 - alpha / 2, n - 1)
  missed <- function(nc) p_noncentral_t(critical, n - 1, nc) - p_noncentral_t(-critical, n - 1, nc)
  dz <- root_of(function(nc) missed(nc) - 0.2, 1, 10) / sqrt(n)
  theirs <- power.t.test(
    n, power = 0.8, sig.level = alpha, type = "one.sample", strict = TRUE, tol = 1e-10
  )$delta
  stopifnot(abs(dz / theirs - 1) < 1e-6)
  list(
    what = "paired test", n = n, alpha = alpha, power = 0.8, dz = dz,
    sign_p = binom.test(n, n)$p.value
  )
}

missing_rows <- function(d) {
  rows <- d$rows
  q <- d$questions[d$questions$item %in% ITEMS & !is.na(d$questions$value), ]
  lists <- list(
    `completion time` = lacking(by_task(rows, d$who, "time")),
    `relative error` = lacking(relative_error(rows, d$who, TRUE)),
    `absolute relative error` = lacking(relative_error(rows, d$who, FALSE)),
    distance = lacking(by_task(rows[rows$task == "unique", ], d$who, "distance")),
    `share correct` = lacking(by_task(rows, d$who, "correct")),
    ratings = if (nrow(q)) lacking(table_of(
      q, sort(unique(d$questions$participant), method = "radix"), "value", list(
        item = levels_in(q$item, ITEMS), scenario = levels_in(q$scenario, SCENARIOS),
        transparency = levels_in(q$transparency, LEVELS)
      )
    ))
  )
  if (two_levels(rows)) lists$`trade-off` <- tradeoff_lacking(d)
  unlist(lapply(names(lists), function(where) {
    lapply(names(lists[[where]]), function(who) {
      list(key = paste0(where, "/", who), cells = paste(lists[[where]][[who]], collapse = "; "))
    })
  }), recursive = FALSE)
}

# tasks in which somebody lacks time or error under one of the levels
tradeoff_lacking <- function(d) {
  cells <- by_task(d$rows, d$who, "time")
  bad <- sapply(cells$factors$task, function(task) {
    rowSums(is.na(cells$values[, task, ])) + rowSums(is.na(own_error(d, task))) > 0
  })
  bad <- matrix(bad, nrow = length(d$who))
  out <- lapply(seq_along(d$who), function(i) cells$factors$task[bad[i, ]])
  names(out) <- d$who
  out[lengths(out) > 0]
}
