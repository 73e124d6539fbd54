# A data folder's raw tables, the plan in a sidecar, and which trials count.

SCENARIOS <- c("abstract", "walkthrough")
TASKS <- c("count", "pattern", "unique", "count_in_building")
LEVELS <- c("standard", "dynamic")

read_tables <- function(folder, ending) {
  base <- file.path(folder, "data")
  files <- list.files(base, pattern = paste0(ending, "$"), recursive = TRUE)
  files <- sort(file.path("data", files), method = "radix")
  tables <- lapply(files, function(name) {
    table <- read.csv(file.path(folder, name), colClasses = "character", na.strings = character(0))
    table$file <- rep(name, nrow(table))
    table$row <- seq_len(nrow(table)) + 1L
    table
  })
  list(files = files, rows = vapply(tables, nrow, 0L), table = do.call(rbind, tables))
}

numbers <- function(table, columns) {
  for (name in columns) table[[name]] <- as.numeric(table[[name]])
  table
}

yes_no <- function(text) ifelse(text == "", NA, as.numeric(text == "true"))

read_folder <- function(folder) {
  trials <- read_tables(folder, "_trials_data.csv")
  asked <- read_tables(folder, "_questionnaire_data.csv")
  t <- numbers(trials$table, c(
    "session", "slot", "trial", "block", "task_set", "trial_in_set", "attempt", "targets",
    "count_error", "distance", "time", "time_clean", "frames", "frames_missed"
  ))
  t$correct <- yes_no(t$correct)
  t$timed_out <- yes_no(t$timed_out)
  sidecar <- jsonlite::fromJSON(
    file.path(folder, sub("\\.csv$", ".json", trials$files[1])),
    simplifyVector = TRUE
  )
  certificate <- file.path(folder, "certificate.csv")
  known <- file.exists(certificate)
  list(
    trials = t,
    questions = numbers(asked$table, "value"),
    plan = sidecar$provenance$study$analysis,
    study = sidecar$provenance$study,
    files = data.frame(
      file = c(trials$files, asked$files, if (known) "certificate.csv"),
      rows = c(trials$rows, asked$rows, if (known) nrow(read.csv(certificate)))
    ),
    certificate = if (known) read.csv(certificate) else NULL,
    simulated = all(t$source == "simulated")
  )
}

# Earlier attempts never count; then each rule of the plan takes out what it hits first.
exclude <- function(trials, rules, too_fast) {
  last <- ave(trials$attempt, paste(trials$participant, trials$trial), FUN = max)
  why <- ifelse(trials$attempt < last, "repeated", "")
  for (rule in rules) {
    hit <- switch(rule,
      timed_out = trials$timed_out == 1,
      focus_lost = trials$time_clean < trials$time,
      frames_missed = trials$source != "simulated" & trials$frames_missed * 20 > trials$frames,
      too_fast = trials$time < too_fast,
      stop("no such rule: ", rule)
    )
    why[hit & why == ""] <- rule
  }
  why
}
