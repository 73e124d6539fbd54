# Every number of `seethrough report --published`, in R: from the printed numbers, and from the
# data that were made to have them.
#
#   Rscript tests/oracles/published.R PUBLISHED.toml STUDY.toml DATA.csv OUT
#
# DATA.csv: measure, standard, dynamic; one row for each of the 16 people. In `detail` of the checks
# stand the numbers of the report's sentence, in order.

options(warn = 1)
invisible(Sys.setlocale("LC_COLLATE", "C"))
here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
for (file in c("distributions", "pairs", "ranks", "compare", "write", "printed", "checks")) {
  source(file.path(here, "r", paste0(file, ".R")), encoding = "UTF-8")
}

N <- 16

tests_rows <- function(paper, data, margins) {
  measures <- lapply(paper$measures, function(m) {
    own <- data[data$measure == m$name, ]
    family <- if (m$name %in% paper$study$tasks) "tasks" else ""
    measure(m$name, own$standard, own$dynamic, family, kind_of(m$name))
  })
  rows <- compare(measures, margins)
  for (i in seq_along(rows)) check_moments(rows[[i]], paper$measures[[i]])
  rows
}

kind_of <- function(name) switch(sub("_.*", "", name), time = "time", error = "count_error", distance = "distance")

# the data must have what is printed, or they are not the paper's
check_moments <- function(row, m) {
  close <- function(a, b) stopifnot(abs(a / as.numeric(b) - 1) < 1e-9)
  close(row$mean_baseline, m$standard$mean)
  close(row$sd_baseline, m$standard$sd)
  close(row$mean_level, m$dynamic$mean)
  close(row$sd_level, m$dynamic$sd)
  close(row$F, m$F)
}

published_rows <- function(paper, tests) {
  lapply(seq_along(tests), function(i) {
    m <- paper$measures[[i]]
    ends <- r_range(m)
    row <- tests[[i]]
    c(
      list(
        measure = m$name, mean_standard = m$standard$mean, sd_standard = m$standard$sd,
        mean_dynamic = m$dynamic$mean, sd_dynamic = m$dynamic$sd, f_published = m$F, p_published = m$p
      ),
      row[c("F", "p")], row["p_holm"], list(r = r_of(m)), list(r_low = ends[1], r_high = ends[2]),
      row[c("pes", "pes_low", "pes_high", "dz", "dz_low", "dz_high")]
    )
  })
}

printed_rows <- function(paper) {
  row <- function(item, m) list(item = item, mean = m$mean, sd = m$sd)
  c(
    list(
      row("correct_T2_standard", paper$correct_T2$standard),
      row("correct_T2_dynamic", paper$correct_T2$dynamic),
      row("rating_standard", paper$rating$standard), row("rating_dynamic", paper$rating$dynamic)
    ),
    lapply(paper$singles, function(s) row(s$name, s))
  )
}

case_row <- function(case, x, y, p_printed) {
  test <- friedman_row(cbind(x, y))
  list(
    case = case, chi2 = test$chi2, p = test$p, p_exact = test$p_exact, p_published = p_printed,
    agrees = if (prints_as(p_printed, test$p, test$p)) "yes" else "no"
  )
}

# who errs in both conditions: every way to give the errors that fit to people
t2_rows <- function(paper) {
  both <- paper$correct_T2
  for (trials in 1:12) {
    first <- errors_that_fit(both$standard, trials)
    second <- errors_that_fit(both$dynamic, trials)
    if (length(first) && length(second)) break
  }
  rows <- list()
  for (a in first) for (b in second) {
    stopifnot(length(b) == 1) # one person errs with the technique, in the paper's numbers
    x <- rep(1, N)
    x[seq_along(a)] <- 1 - a / trials
    for (i in c(seq_along(a), length(a) + 1)) {
      y <- rep(1, N)
      y[i] <- 1 - b / trials
      other <- if (i <= length(a)) {
        sprintf("one with %d/%d wrong in standard", a[i], trials)
      } else {
        "one without errors in standard"
      }
      rows <- c(rows, list(case_row(
        sprintf("%d/%d wrong in dynamic: %s", b, trials, other), x, y, both$p
      )))
    }
  }
  rows
}

rating_rows <- function(paper, data) {
  own <- data[data$measure == "rating", ]
  for (level in c("standard", "dynamic")) {
    stopifnot(fits(mean(own[[level]]), paper$rating[[level]]$mean))
    stopifnot(fits(sd(own[[level]]), paper$rating[[level]]$sd))
    whole_sums <- own[[level]] * as.numeric(paper$rating$items)
    stopifnot(all(abs(whole_sums - round(whole_sums)) < 1e-9))
  }
  x <- sort(own$standard, decreasing = TRUE)
  y <- sort(own$dynamic, decreasing = TRUE)
  list(
    case_row("paired high with high", x, y, paper$rating$p),
    case_row("paired high with low", x, rev(y), paper$rating$p)
  )
}

# T2 without an F: the s.d. of a difference is at most the sum of the two, the gap at most what
# rounding allows. Its numbers are impossible, so no verdict.
equality_rows <- function(tests, paper, margins) {
  keys <- sapply(tests, function(r) r$measure)
  verdict <- function(p) if (p < 0.05) "yes" else "not shown"
  rows <- lapply(c("error_T4", "distance_T3"), function(key) {
    row <- tests[[match(key, keys)]]
    list(
      measure = key, margin = row$tost_margin, p = row$tost_p, shown = verdict(row$tost_p),
      noninferior_p = row$noninferior_p, no_worse = verdict(row$noninferior_p)
    )
  })
  a <- paper$correct_T2$standard
  b <- paper$correct_T2$dynamic
  gap <- max(abs(high(a$mean) - low(b$mean)), abs(high(b$mean) - low(a$mean)))
  error <- (high(a$sd) + high(b$sd)) / sqrt(N)
  p <- pt((margins$correct - gap) / error, N - 1, lower.tail = FALSE)
  none <- "not to be told: the numbers are impossible"
  c(rows, list(list(
    measure = "correct_T2", margin = margins$correct, p = p, shown = none, noninferior_p = p,
    no_worse = none
  )))
}

main <- function(toml, study, file, out) {
  paper <- read_paper(toml)
  margins <- lapply(read_paper(study)$analysis.margins, as.numeric)
  data <- read.csv(file)
  tests <- tests_rows(paper, data, margins)
  checks <- all_checks(paper)
  bad <- Filter(function(c) c$fits != "yes", checks)
  count <- function(what, n) list(what = what, count = n)
  tables <- list(
    tests_published = tests, published = published_rows(paper, tests), printed = printed_rows(paper),
    consistency = checks, inconsistent = bad,
    consistency_counts = list(
      count("asked", length(checks)), count("fitting", length(checks) - length(bad)),
      count("not fitting", length(bad))
    ),
    friedman_t2 = t2_rows(paper), friedman_rating = rating_rows(paper, data),
    equivalence = equality_rows(tests, paper, margins)
  )
  write_tables(tables, out)
}

arguments <- commandArgs(TRUE)
main(arguments[1], arguments[2], arguments[3], arguments[4])
