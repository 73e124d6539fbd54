# Do the printed numbers fit each other? `detail` holds the numbers of the report's sentence.

check <- function(key, ok, ...) {
  numbers <- unlist(list(...))
  said <- if (is.logical(ok)) c("no", "yes")[ok + 1] else ok
  list(check = key, fits = said, detail = paste(numbers, collapse = " "))
}

rounded <- function(x, digits) formatC(x, digits = digits, format = "f")
# a half that is exact in decimals goes up, whatever its double says
half_up <- function(x, digits) rounded(floor(x * 10^digits + 0.5 + 1e-9) / 10^digits, digits)
p_text <- function(p) ifelse(p < 0.001, ".001", rounded(p, 3))

p_check <- function(m) {
  tail <- function(f) pf(f, 1, N - 1, lower.tail = FALSE)
  p <- tail(c(as.numeric(m$F), high(m$F), low(m$F)))
  check(
    paste0("p_", m$name), prints_as(m$p, p[2], p[3]),
    1, N - 1, m$F, rounded(p, 6), sub("< ", "", m$p)
  )
}

r_check <- function(m) {
  ends <- r_range(m)
  check(paste0("r_", m$name), ends[1] <= 1 && ends[2] >= -1, rounded(c(r_of(m), ends), 3))
}

by_name <- function(paper, name) Filter(function(m) m$name == name, paper$measures)[[1]]
LEVEL_NAMES <- c("standard", "dynamic")

overall_check <- function(paper) {
  parts <- lapply(paper$study$tasks, by_name, paper = paper)
  overall <- by_name(paper, "time_overall")
  plain <- sapply(LEVEL_NAMES, function(l) mean(sapply(parts, function(m) as.numeric(m[[l]]$mean))))
  room <- sapply(LEVEL_NAMES, function(l) {
    mean(sapply(parts, function(m) half(m[[l]]$mean))) + half(overall[[l]]$mean)
  })
  printed <- sapply(LEVEL_NAMES, function(l) overall[[l]]$mean)
  grid <- as.matrix(expand.grid(rep(list(1:20), 4))[, 4:1])
  good <- rep(TRUE, nrow(grid))
  for (l in LEVEL_NAMES) {
    lows <- sapply(parts, function(m) low(m[[l]]$mean))
    highs <- sapply(parts, function(m) high(m[[l]]$mean))
    total <- rowSums(grid)
    good <- good & drop(grid %*% highs) / total >= low(overall[[l]]$mean) &
      drop(grid %*% lows) / total <= high(overall[[l]]$mean)
  }
  found <- grid[good, , drop = FALSE]
  gcd <- function(a, b) if (b == 0) a else gcd(b, a %% b)
  found <- found[apply(found, 1, function(w) Reduce(gcd, w)) == 1, , drop = FALSE]
  small <- found[apply(found, 1, max) <= 12, , drop = FALSE]
  stopifnot(nrow(small) == 0) # the sentence would be another one
  check(
    "overall_time", all(abs(plain - as.numeric(printed)) <= room),
    half_up(plain, 2), printed, 12, 20, t(head(found, 3))
  )
}

combined_checks <- function(paper) {
  a <- by_name(paper, "error_T1")
  b <- by_name(paper, "error_T4")
  both <- by_name(paper, "error_T1_T4")
  number <- function(m, l) as.numeric(m[[l]]$mean)
  plain <- sapply(LEVEL_NAMES, function(l) (number(a, l) + number(b, l)) / 2)
  weights <- sapply(LEVEL_NAMES, function(l) {
    ends <- function(m) c(low(m[[l]]$mean), high(m[[l]]$mean))
    g <- expand.grid(ends(both), ends(a), ends(b))
    range((g[, 1] - g[, 2]) / (g[, 3] - g[, 2]))
  })
  most <- (high(a$standard$sd) + high(b$standard$sd)) / 2
  list(
    check(
      "combined_error_mean", all(mapply(function(p, l) fits(p, both[[l]]$mean), plain, LEVEL_NAMES)),
      rounded(plain, 4), both$standard$mean, both$dynamic$mean
    ),
    check("combined_error_weights", max(weights[1, ]) <= min(weights[2, ]), rounded(weights, 2)),
    check("combined_error_sd", low(both$standard$sd) <= most, rounded(most, 3), 1, both$standard$sd)
  )
}

# errors per person (of `trials`), zeros left out, with the printed mean and s.d. of shares right
errors_that_fit <- function(m, trials, n = N, printed = fits) {
  found <- list()
  place <- function(left, most, so_far) {
    if (left == 0) {
      shares <- c(1 - so_far / trials, rep(1, n - length(so_far)))
      if (fits(sd(shares), m$sd)) found[[length(found) + 1]] <<- so_far
      return()
    }
    if (length(so_far) == n) return()
    for (e in min(left, most):1) place(left - e, e, c(so_far, e))
  }
  for (right in 0:(n * trials)) {
    if (printed(right / (n * trials), m$mean)) place(n * trials - right, trials, c())
  }
  found
}

correct_checks <- function(paper) {
  m <- paper$correct_T2$standard
  per <- as.numeric(paper$study$trials_per_task_and_condition)
  count <- N * per
  below <- floor(as.numeric(m$mean) * count)
  near <- c(below, below + 1)
  mixed <- any(fits((0:(N * 12)) / (N * 12), m$mean)) # 12: least common multiple of 1 to 4
  stopifnot(!mixed) # the sentence would hold a number
  ok <- lapply(1:12, function(t) {
    lapply(LEVEL_NAMES, function(l) errors_that_fit(paper$correct_T2[[l]], t))
  })
  both <- which(sapply(ok, function(o) length(o[[1]]) > 0 && length(o[[2]]) > 0))
  first <- ok[[both[1]]]
  list(
    check(
      "grim_correct", any(fits((0:count) / count, m$mean)),
      near[1], count, rounded(near[1] / count, 3), near[2], count, rounded(near[2] / count, 3)
    ),
    check("grim_correct_mixed", mixed),
    check(
      "grimmer_correct", per %in% both, both, per,
      unlist(lapply(first, function(errors) rbind(errors[[1]], both[1])))
    ),
    rounding_check(paper, both),
    people_check(paper, per)
  )
}

# what lies on a half prints so only where that makes the last digit even
fits_to_even <- function(value, text) {
  on_half <- abs(abs(value - as.numeric(text)) - half(text)) < 1e-9
  if (on_half) grepl("[02468]$", text) else fits(value, text)
}

rounding_check <- function(paper, both) {
  left <- Filter(function(t) {
    all(sapply(LEVEL_NAMES, function(l) {
      length(errors_that_fit(paper$correct_T2[[l]], t, printed = fits_to_even)) > 0
    }))
  }, both)
  lost <- setdiff(both, left)
  stopifnot(length(lost) > 0, length(left) == 0) # the sentence would be another one
  m <- paper$correct_T2$standard$mean
  halves <- unlist(lapply(lost, function(t) {
    Filter(function(share) fits(share, m), (0:(N * t)) / (N * t))
  }))
  halves <- unique(halves)
  check("grimmer_correct_rounding", FALSE, lost, halves, m, 12)
}

# fewer people, with the trials that are stated
people_check <- function(paper, per) {
  found <- c()
  whole <- c()
  for (n in (N - 1):2) {
    right <- lapply(LEVEL_NAMES, function(l) {
      which(fits((0:(n * per)) / (n * per), paper$correct_T2[[l]]$mean)) - 1
    })
    if (any(lengths(right) == 0)) next
    found <- c(found, n, per, max(right[[1]]), n * per)
    ok <- sapply(LEVEL_NAMES, function(l) length(errors_that_fit(paper$correct_T2[[l]], per, n)) > 0)
    if (all(ok)) whole <- c(whole, n)
  }
  said <- if (is.null(found)) TRUE else if (is.null(whole)) "the means, not the SD" else "they would"
  check("grim_correct_people", said, found, whole)
}

# sums and sums of squares that n whole numbers from 0 to `most` can have: a logical matrix
reachable <- function(n, most, largest_sum) {
  squares <- largest_sum * most
  now <- matrix(FALSE, largest_sum + 1, squares + 1)
  now[1, 1] <- TRUE
  for (i in seq_len(n)) {
    new <- now
    for (v in seq_len(most)) {
      a <- seq_len(largest_sum + 1 - v)
      b <- seq_len(squares + 1 - v^2)
      new[a + v, b + v^2] <- new[a + v, b + v^2] | now[a, b]
    }
    now <- new
  }
  now
}

# the pairs of them with the printed mean and s.d. of numbers that are divided by `per`
moments_that_fit <- function(m, most, per = 1) {
  totals <- Filter(function(t) fits(t / (N * per), m$mean), 0:(N * most))
  if (!length(totals)) return(NULL)
  can <- reachable(N, most, max(totals))
  pairs <- NULL
  for (t in totals) {
    q <- which(can[t + 1, ]) - 1
    s <- sqrt(pmax(0, (q - t^2 / N) / (N - 1))) / per
    q <- q[fits(s, m$sd)]
    if (length(q)) pairs <- rbind(pairs, cbind(t, q))
  }
  pairs
}

single_checks <- function(paper) {
  lapply(paper$singles, function(s) {
    pairs <- moments_that_fit(s, as.numeric(s$highest))
    # any answers with these sums will do; the report's are checked where it gives them
    check(paste0("grim_", s$name), !is.null(pairs))
  })
}

rating_check <- function(paper) {
  per <- as.numeric(paper$rating$items)
  most <- per * as.numeric(paper$rating$highest)
  ok <- sapply(LEVEL_NAMES, function(l) !is.null(moments_that_fit(paper$rating[[l]], most, per)))
  printed <- lapply(LEVEL_NAMES, function(l) unlist(paper$rating[[l]][c("mean", "sd")]))
  check("grim_rating", all(ok), printed)
}

multiplicity_check <- function(paper) {
  parts <- lapply(paper$study$tasks, by_name, paper = paper)
  p <- sapply(parts, function(m) pf(as.numeric(m$F), 1, N - 1, lower.tail = FALSE))
  holm <- p.adjust(p, "holm")
  most <- p.adjust(p, "bonferroni")
  fits <- if (max(holm) < 0.05 && any(most >= 0.05)) "Holm" else any(most < 0.05)
  check("multiplicity", fits, rbind(p_text(holm), p_text(most)))
}

all_checks <- function(paper) {
  c(
    lapply(paper$measures, p_check), lapply(paper$measures, r_check), list(overall_check(paper)),
    combined_checks(paper), correct_checks(paper), single_checks(paper), list(rating_check(paper)),
    list(multiplicity_check(paper))
  )
}
