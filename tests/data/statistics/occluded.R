# Numbers that tests/unit/analysis/test_outside_data.py holds the analysis to, of people's ratings of
# five views of things that hide each other, each of five objects.
#
#   Rscript tests/data/statistics/occluded.R tests/data/statistics
#
# occluded.csv: "liked overall", 24 people × 5 objects × 5 views, from the data of K. Lilija, H. Pohl,
# S. Boring and K. Hornbæk: Augmented reality views for occluded interaction, CHI 2019, in the package
# hcidata of H. Pohl (github.com/henningpohl/hcidata, data-raw/OccludedInteraction.csv), under the
# licence CC BY 4.0 (creativecommons.org/licenses/by/4.0). Changed: the rows of one question, four of
# its columns.

suppressPackageStartupMessages(library(afex))
options(contrasts = c("contr.sum", "contr.poly"))
place <- commandArgs(TRUE)[1]
d <- read.csv(file.path(place, "occluded.csv"))
d$user <- factor(d$user)
views <- c("none", "static", "dynamic", "cloned", "see-through")
y <- tapply(d$rating, list(d$user, factor(d$view, views)), mean)
fit <- suppressWarnings(aov_ez("user", "rating", d, within = c("view", "object"), type = 3,
  anova_table = list(correction = "none", es = "ges")))
table <- as.data.frame(fit$anova_table)
eps <- suppressWarnings(summary(fit))$pval.adjustments
rows <- list()
add <- function(what, value) rows[[length(rows) + 1]] <<- data.frame(what = what, value = format(value, digits = 15))
for (e in rownames(table)) {
  add(paste("F", e), table[e, "F"])
  add(paste("ges", e), table[e, "ges"])
  add(paste("eps", e), eps[e, "GG eps"])
}
y <- round(y, 9)
test <- friedman.test(y)
add("friedman chi2", unname(test$statistic))
add("friedman p", test$p.value)
for (pair in combn(5, 2, simplify = FALSE)) {
  name <- paste(views[pair], collapse = " - ")
  gap <- round(y[, pair[1]] - y[, pair[2]], 9)
  add(paste("V", name), sum(rank(abs(gap[gap != 0]))[gap[gap != 0] > 0]))
  add(paste("p", name), exactRankTests::wilcox.exact(gap, exact = TRUE)$p.value)
}
five <- tapply(d$rating, list(d$user, d$view, d$object), mean)[, "none", ]
a <- suppressMessages(suppressWarnings(psych::alpha(five, check.keys = FALSE)))
add("alpha of objects", a$total$raw_alpha)
add("alpha low", a$feldt$lower.ci[[1]])
add("alpha high", a$feldt$upper.ci[[1]])
f <- factanal(covmat = cov(five), n.obs = nrow(five), factors = 1, control = list(opt = list(factr = 1)))
common <- sum(f$loadings[, 1] * apply(five, 2, sd))^2
add("omega of objects", common / (common + sum(f$uniquenesses * apply(five, 2, var))))
write.csv(do.call(rbind, rows), file.path(place, "occluded_numbers.csv"), row.names = FALSE)
