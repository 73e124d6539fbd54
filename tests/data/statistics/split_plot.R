# Numbers that tests/unit/analysis/test_split_plot.py holds the analysis to: afex's split-plot ANOVA,
# base R's Welch test, contr.poly. The data are our own, from a seed.
#
#   Rscript tests/data/statistics/split_plot.R tests/data/statistics

options(warn = 1, contrasts = c("contr.sum", "contr.poly"))
out <- commandArgs(TRUE)[1]
set.seed(18)
# two factors between people (unequal groups of 3 to 7), two within (3 × 2)
sizes <- expand.grid(training = c("none", "some", "much"), age = c("young", "old"))
sizes$n <- c(3, 5, 4, 6, 3, 7)
people <- sizes[rep(seq_len(nrow(sizes)), sizes$n), 1:2]
people$participant <- sprintf("p%02d", seq_len(nrow(people)))
people$level <- rnorm(nrow(people), 10, 2) + 1.5 * (people$training == "much")
d <- merge(people, expand.grid(view = c("plain", "cut", "lens"), light = c("day", "night")))
d$y <- round(d$level - 1.2 * (d$view == "cut") * (d$training != "none") + 0.8 * (d$light == "night") + rnorm(nrow(d)), 3)
d <- d[order(d$participant, d$view, d$light), c("participant", "training", "age", "view", "light", "y")]
write.csv(d, file.path(out, "split_plot_data.csv"), row.names = FALSE)

one <- function(measured, data = d, within = c("view", "light"), between = c("training", "age")) {
  fit <- suppressMessages(suppressWarnings(afex::aov_ez("participant", "y", data,
    within = within, between = between, observed = measured, type = 3,
    anova_table = list(correction = "none", es = c("ges", "pes")))))
  t <- as.data.frame(fit$anova_table)
  adjust <- suppressWarnings(summary(fit))$pval.adjustments
  data.frame(
    case = paste(c("measured", measured), collapse = " "), effect = gsub(":", " × ", rownames(t)),
    df1 = t$"num Df", df2 = t$"den Df", F = t$F, p = t$"Pr(>F)", ges = t$ges, pes = t$pes,
    eps = sapply(rownames(t), function(e) if (e %in% rownames(adjust)) adjust[e, "GG eps"] else 1),
    hf = sapply(rownames(t), function(e) if (e %in% rownames(adjust)) min(1, adjust[e, "HF eps"]) else 1)
  )
}
rows <- rbind(one(NULL), one("age"), one(c("age", "training")))
rows[-(1:2)] <- lapply(rows[-(1:2)], format, digits = 15)
write.csv(rows, file.path(out, "split_plot.csv"), row.names = FALSE, fileEncoding = "UTF-8")

# contrasts: of the persons' means, young less old, by Welch; of cut less plain
means <- aggregate(y ~ participant + age, d, mean)
w <- t.test(y ~ factor(age, c("young", "old")), means)
cut <- with(d[d$view == "plain", ], tapply(y, participant, mean)) - with(d[d$view == "cut", ], tapply(y, participant, mean))
s <- t.test(cut)
x <- c(80, 180, 380, 400)
q <- contr.poly(4, scores = x)
k <- kruskal.test(y ~ training, aggregate(y ~ participant + training, d, mean))
rows <- data.frame(
  what = c("welch t", "welch df", "welch p", "welch low", "welch high", "one t", "one df", "one p",
    paste("quadratic", 1:4), "kruskal h", "kruskal p", "exact rank sum p"),
  value = format(c(w$statistic, w$parameter, w$p.value, w$conf.int, s$statistic, s$parameter, s$p.value,
    q[, 2], k$statistic, k$p.value,
    exactRankTests::wilcox.exact(c(1, 2, 2, 3, 5), c(2, 4, 5, 5, 6, 7), exact = TRUE)$p.value), digits = 15)
)
write.csv(rows, file.path(out, "contrasts.csv"), row.names = FALSE)
