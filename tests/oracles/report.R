# Every number of the report's tables, in R, from a data folder's raw CSV files.
#
#   Rscript tests/oracles/report.R DATA OUT
#
# Written from the definitions (README.md beside this file), not from the analysis that it checks.
# Writes OUT/TABLE.csv with the report's keys and column names. An empty cell means that the report
# leaves the cell empty, `undefined` that the number does not exist.

options(warn = 1, contrasts = c("contr.sum", "contr.poly"))
# sorting and printing must not depend on the machine's language
invisible(Sys.setlocale("LC_COLLATE", "C"))

here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
for (file in c(
  "write", "read", "distributions", "cells", "pairs", "anova", "ranks", "compare", "sections", "validity",
  "participants", "mixed", "robust"
)) source(file.path(here, "r", paste0(file, ".R")), encoding = "UTF-8")

main <- function(folder, out) {
  data <- read_folder(folder)
  why <- exclude(data$trials, unlist(data$plan$exclude), data$plan$too_fast)
  d <- list(
    recorded = data$trials, why = why, rows = data$trials[why == "", ],
    who = people_of(data$trials), questions = data$questions, files = data$files,
    alpha = data$plan$alpha,
    margins = as.list(data$plan$margins), certificate = data$certificate, simulated = data$simulated
  )
  tables <- c(
    participants_tables(d), time_tables(d), accuracy_tables(d), ratings_tables(d),
    tradeoff_tables(d), list(order = order_rows(d)), learning_tables(d),
    list(faults = fault_rows(d), difficulty = difficulty_rows(d), mixed_model = mixed_row(d)),
    list(mixed_scenes = scenes_row(d, mixed_row(d)[[1]])),
    list(robust = robust_rows(d))
  )
  write_tables(tables, out)
}

arguments <- commandArgs(TRUE)
main(arguments[1], arguments[2])
