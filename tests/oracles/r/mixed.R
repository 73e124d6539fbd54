# The mixed model of single trials: lme4's fit, t on n − 1.

mixed_row <- function(d) {
  rows <- d$rows
  n <- length(unique(rows$participant))
  out <- list(
    effect = "transparency", n = n, trials = nrow(rows), estimate = undefined, error = undefined,
    t = undefined, df = n - 1, p = undefined, ratio = undefined, low = undefined, high = undefined,
    sd_slope = undefined
  )
  if (!two_levels(rows) || n < 3) return(list(out))
  y <- log(rows$time)
  # a unit of about one: the fit's tolerances are absolute
  unit <- sd0(y)
  rows$y <- shifted(y) / unit
  rows$technique <- ifelse(rows$transparency == "dynamic", 0.5, -0.5)
  tasks <- levels_in(rows$task, TASKS)
  rows$task <- factor(rows$task, tasks)
  formula <- if (length(tasks) > 1) {
    contrasts(rows$task) <- contr.sum(length(tasks))
    y ~ technique * task + (1 + technique | participant)
  } else {
    y ~ technique + (1 + technique | participant)
  }
  control <- lme4::lmerControl(
    optimizer = "bobyqa", optCtrl = list(rhoend = 1e-10, maxfun = 1e5), calc.derivs = FALSE,
    check.conv.singular = "ignore"
  )
  fit <- lme4::lmer(formula, rows, REML = TRUE, control = control)
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
  out$sd_slope <- attr(lme4::VarCorr(fit)$participant, "stddev")[["technique"]] * unit
  list(out)
}
