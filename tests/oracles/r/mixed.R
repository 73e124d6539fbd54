# The mixed model of single trials: lme4's fit, t on n − 1.

# fullest first; the first that has fewer random effects than there are trials
RANDOM <- list(
  c("(1 + technique | participant)", "(1 + technique | participant:task)"),
  c("(1 + technique | participant)", "(1 | participant:task)"),
  "(1 + technique | participant)",
  "(1 | participant)"
)

random_effects <- function(term, rows) {
  groups <- if (grepl(":", term)) paste(rows$participant, rows$task) else rows$participant
  length(unique(groups)) * if (grepl("technique", term)) 2 else 1
}

mixed_row <- function(d) {
  rows <- d$rows
  met <- tapply(rows$transparency, rows$participant, function(t) length(unique(t)))
  n <- sum(met == 2)
  gone <- c(
    "estimate", "error", "t", "p", "ratio", "low", "high", "sd_slope", "sd_task_slope"
  )
  out <- c(
    list(effect = "transparency", n = n, trials = nrow(rows), df = n - 1, model = "", singular = ""),
    setNames(rep(list(undefined), length(gone)), gone)
  )
  if (!two_levels(rows) || n < 3) return(list(out))
  y <- log(rows$time)
  # a unit of about one, and no offset: the fit's tolerances are absolute
  unit <- sd0(y)
  rows$y <- shifted(y) / unit
  rows$technique <- ifelse(rows$transparency == "dynamic", 0.5, -0.5)
  tasks <- levels_in(rows$task, TASKS)
  rows$task <- factor(rows$task, tasks)
  fixed <- "technique"
  if (length(tasks) > 1) {
    contrasts(rows$task) <- contr.sum(length(tasks))
    fixed <- "technique * task"
  }
  for (terms in RANDOM) {
    if (length(tasks) == 1 && length(terms) > 1) next
    if (any(sapply(terms, random_effects, rows = rows) >= nrow(rows))) next
    break
  }
  fit <- fit_of(paste("y ~", paste(c(fixed, terms), collapse = " + ")), rows)
  own <- summary(fit)$coefficients["technique", ]
  estimate <- own[["Estimate"]] * unit
  error <- own[["Std. Error"]] * unit
  ends <- estimate + c(-1, 1) * qt(0.975, n - 1) * error
  out$estimate <- estimate
  out$error <- error
  out$t <- estimate / error
  out$p <- 2 * pt(-abs(out$t), n - 1)
  out$ratio <- exp(estimate)
  out$low <- exp(ends[1])
  out$high <- exp(ends[2])
  out$sd_slope <- slope_of(fit, "participant", unit)
  out$sd_task_slope <- slope_of(fit, "participant:task", unit)
  out$model <- gsub("technique", "transparency", paste(terms, collapse = " + "))
  out$singular <- if (lme4::isSingular(fit, tol = 1e-4)) "true" else "false"
  list(out)
}

# The same model with scenes crossed: those that two people met, from seven on; fullest first, none
# whose variance is 0. `plain` is the row above.
scenes_row <- function(d, plain) {
  rows <- d$rows
  if (plain$model == "") return(NULL)
  pairs <- unique(rows[c("scene", "participant")])
  met <- table(pairs$scene)
  shared <- names(met)[met > 1]
  if (length(shared) < 7) return(NULL)
  y <- log(rows$time)
  unit <- sd0(y)
  rows$y <- shifted(y) / unit
  rows$technique <- ifelse(rows$transparency == "dynamic", 0.5, -0.5)
  tasks <- levels_in(rows$task, TASKS)
  rows$task <- factor(rows$task, tasks)
  fixed <- "technique"
  if (length(tasks) > 1) {
    contrasts(rows$task) <- contr.sum(length(tasks))
    fixed <- "technique * task"
  }
  rows$s0 <- as.numeric(rows$scene %in% shared)
  rows$s1 <- rows$s0 * rows$technique
  # trials of other scenes: one more scene, of which no effect enters anything
  rows$scene[rows$s0 == 0] <- "-"
  both <- table(unique(rows[rows$s0 == 1, c("scene", "transparency")])$scene)
  steps <- c("(0 + s0 + s1 | scene)", "(0 + s0 | scene)")
  for (step in steps) {
    slopes <- grepl("s1", step)
    if (slopes && sum(both == 2) < 7) next
    if (length(shared) * (1 + slopes) >= sum(rows$s0)) next
    nested <- gsub("transparency", "technique", plain$model)
    fit <- fit_of(paste("y ~", paste(c(fixed, nested, step), collapse = " + ")), rows)
    theta <- lme4::getME(fit, "Tlist")[["scene"]]
    if (min(svd(theta)$d) < 0.01) next
    own <- summary(fit)$coefficients["technique", ]
    estimate <- own[["Estimate"]] * unit
    error <- own[["Std. Error"]] * unit
    df <- min(plain$df, length(shared) - 1)
    ends <- estimate + c(-1, 1) * qt(0.975, df) * error
    spread <- attr(lme4::VarCorr(fit)$scene, "stddev") * unit
    words <- if (slopes) "(1 + transparency | scene)" else "(1 | scene)"
    nested_singular <- any(sapply(setdiff(names(lme4::getME(fit, "Tlist")), "scene"), function(g) {
      min(abs(diag(lme4::getME(fit, "Tlist")[[g]]))) < 1e-4
    }))
    return(list(list(
      effect = "transparency", scenes = length(shared), trials = nrow(rows), estimate = estimate,
      error = error, t = estimate / error, df = df, p = 2 * pt(-abs(estimate / error), df),
      ratio = exp(estimate), low = exp(ends[1]), high = exp(ends[2]), sd_scene = spread[["s0"]],
      sd_slope = if (slopes) spread[["s1"]] else "", model = paste(plain$model, words, sep = " + "),
      singular = if (nested_singular) "true" else "false"
    )))
  }
  NULL
}

slope_of <- function(fit, group, unit) {
  found <- lme4::VarCorr(fit)[[group]]
  if (is.null(found) || !"technique" %in% colnames(found)) return(undefined)
  sqrt(found["technique", "technique"]) * unit
}

# The lowest REML criterion there is: the surface has several dips, and lme4's own optimisers, which
# start once, end in a shallow one for some of these data. So lme4's criterion, from many starts.
fit_of <- function(formula, rows) {
  control <- function(optimizer) {
    lme4::lmerControl(optimizer = optimizer, calc.derivs = FALSE, check.conv.singular = "ignore")
  }
  formula <- as.formula(formula)
  first <- lme4::lmer(formula, rows, control = control("bobyqa"))
  criterion <- lme4::lmer(formula, rows, control = control("bobyqa"), devFunOnly = TRUE)
  lower <- lme4::getME(first, "lower")
  set.seed(1)
  starts <- c(list(lme4::getME(first, "theta")), lapply(seq_len(if (nrow(rows) > 1000) 3 else 15), function(i) {
    ifelse(lower == 0, runif(length(lower), 0, 1.2), runif(length(lower), -0.8, 0.8))
  }))
  ends <- lapply(starts, function(theta) {
    for (again in 1:2) {
      theta <- nlminb(theta, criterion, lower = lower, control = list(
        rel.tol = 1e-15, x.tol = 1e-12, eval.max = 2000, iter.max = 2000
      ))$par
    }
    list(theta = theta, value = criterion(theta))
  })
  best <- ends[[which.min(sapply(ends, function(e) e$value))]]
  lme4::lmer(formula, rows, start = best$theta, control = control(NULL))
}
