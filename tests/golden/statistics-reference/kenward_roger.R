# Makes expected/kenward_roger.json with pbkrtest from the files of lmm_random_terms.R:
#   Rscript kenward_roger.R          in this folder
# The optimiser's tolerances are those of lmm_random_terms.R: pbkrtest takes the variances from where lme4 ended.
suppressMessages({library(lme4); library(pbkrtest); library(jsonlite)})
tight <- lmerControl(optimizer = "nloptwrap", calc.derivs = FALSE, check.conv.singular = "ignore",
                     optCtrl = list(algorithm = "NLOPT_LN_BOBYQA", xtol_abs = 1e-13, xtol_rel = 1e-13, ftol_abs = 0, ftol_rel = 0, maxeval = 1e5))
fits <- fromJSON("expected/lmm_random_terms.json")$fits
out <- list()
for (name in setdiff(names(fits), "sim_crossed_5")) {   # sim_crossed_5: variances of 0, where pbkrtest and a search's end decide
  formula <- as.formula(fits[[name]]$formula)
  rows_ <- read.csv(fits[[name]]$data); for (g in intersect(c("batch", "cask", "plate", "sample", "scenario", "surgeon"), names(rows_))) rows_[[g]] <- factor(rows_[[g]])
  fit <- lmer(formula, rows_, control = tight)
  for (k in 1:3) fit <- update(fit, start = getME(fit, "theta"))
  p <- length(fixef(fit)); adjusted <- as.matrix(vcovAdj(fit))
  test <- function(L) { k <- KRmodcomp(fit, L)$stats; list(F = k$Fstat, df1 = k$ndf, df2 = k$ddf, scale = k$F.scaling, p = k$p.value) }
  one <- function(j) { L <- matrix(0, 1, p); L[1, j] <- 1; test(L) }
  joint <- if (p > 2) test(cbind(0, diag(p - 1)))
  out[[name]] <- list(se = sqrt(diag(adjusted)), df = sapply(seq_len(p), function(j) one(j)$df2), p = sapply(seq_len(p), function(j) one(j)$p),
                      covariance = unname(adjusted), joint = joint)
}
writeLines(toJSON(list(made_with = paste("R", getRversion(), "lme4", packageVersion("lme4"), "pbkrtest", packageVersion("pbkrtest")),
                       fits = out), digits = NA, auto_unbox = TRUE, pretty = TRUE), "expected/kenward_roger.json")
