# Makes data/sim_crossed_*.csv, data/penicillin.csv, data/pastes.csv and expected/lmm_random_terms.json with lme4 and lmerTest:
#   Rscript lmm_random_terms.R          in this folder
# The optimiser's tolerances are far below lme4's own, so that the reference is the minimum and not where a search stopped.
suppressMessages({library(lme4); library(lmerTest); library(jsonlite)})
tight <- lmerControl(optimizer = "nloptwrap", calc.derivs = FALSE, check.conv.singular = "ignore",
                     optCtrl = list(algorithm = "NLOPT_LN_BOBYQA", xtol_abs = 1e-13, xtol_rel = 1e-13, ftol_abs = 0, ftol_rel = 0, maxeval = 1e5))

# The best of fits that start anywhere, polished by Newton-like restarts from where the last one ended.
best <- function(formula, data, reml) {
  fits <- lapply(list(NULL, 0.3, 2), function(s) {
    start <- if (is.null(s)) NULL else {
      f <- lFormula(formula, data, REML = reml); s * f$reTrms$theta
    }
    fit <- lme4::lmer(formula, data, REML = reml, control = tight, start = start)
    for (k in 1:3) fit <- update(fit, start = getME(fit, "theta"))
    fit
  })
  fits[[which.min(sapply(fits, function(f) if (reml) REMLcrit(f) else deviance(f)))]]
}

described <- function(name, formula, data, response) {
  reml <- best(formula, data, TRUE); ml <- best(formula, data, FALSE)
  assign("rows_", data, .GlobalEnv); assign("theta_", getME(reml, "theta"), .GlobalEnv)
  tests <- coef(summary(do.call(lmerTest::lmer, list(formula, data = quote(rows_), control = quote(tight), start = quote(theta_)))))
  list(data = paste0("data/", name, ".csv"), formula = deparse1(formula), response = response,
       fixef = unname(fixef(reml)), se = unname(sqrt(diag(as.matrix(vcov(reml))))), df = unname(tests[, "df"]),
       sigma_squared = sigma(reml)^2, reml_criterion = REMLcrit(reml), singular = isSingular(reml, tol = 1e-4),
       covariances = lapply(VarCorr(reml), function(v) unname(matrix(as.numeric(v), nrow(v)))),
       first_effects = lapply(ranef(reml), function(r) unname(as.numeric(r[1, ]))),
       first_levels = lapply(ranef(reml), function(r) rownames(r)[1]),
       ml = list(deviance = as.numeric(-2 * logLik(ml)), fixef = unname(fixef(ml)), sigma_squared = sigma(ml)^2))
}

simulated <- function(seed, surgeons, scenarios, rows, slope_sd, between_sd = 1) {
  set.seed(seed)
  intercept <- rnorm(surgeons, 0, between_sd)
  slope <- slope_sd * (0.5 * intercept + rnorm(surgeons))
  bump <- rnorm(scenarios, 0, 0.6)
  who <- sample(surgeons, rows, TRUE); what <- sample(scenarios, rows, TRUE); trial <- sample(12, rows, TRUE)
  y <- 3 - 0.2 * trial + intercept[who] + slope[who] * trial + bump[what] + rnorm(rows, 0, 0.8)
  data.frame(y = signif(y, 8), trial, surgeon = sprintf("s%02d", who), scenario = sprintf("c%d", what))
}

sets <- list(
  sim_crossed_1 = list(simulated(1, 20, 6, 300, 0), y ~ trial + (1 | surgeon) + (1 | scenario)),
  sim_crossed_2 = list(simulated(2, 24, 8, 400, 0.1), y ~ trial + (1 + trial | surgeon) + (1 | scenario)),
  sim_crossed_3 = list(simulated(3, 12, 5, 90, 0.05), y ~ trial + (1 + trial | surgeon) + (1 | scenario)),
  sim_crossed_4 = list(simulated(4, 30, 10, 500, 0.1), y ~ trial + scenario + (0 + trial | surgeon) + (1 | surgeon)),
  sim_crossed_5 = list(simulated(5, 15, 4, 120, 0, 0), y ~ trial + (1 | surgeon) + (1 | scenario)),
  sim_crossed_6 = list(simulated(6, 8, 6, 200, 0.2), y ~ trial + (1 + trial | surgeon) + (1 + trial | scenario)),
  penicillin = list(Penicillin, diameter ~ 1 + (1 | plate) + (1 | sample)),
  pastes = list(Pastes, strength ~ 1 + (1 | batch) + (1 | batch:cask)))

dir.create("data", FALSE); out <- list()
for (name in names(sets)) {
  data <- sets[[name]][[1]]
  write.csv(data, paste0("data/", name, ".csv"), row.names = FALSE, quote = FALSE)
  out[[name]] <- described(name, sets[[name]][[2]], data, all.vars(sets[[name]][[2]])[1])
}
writeLines(toJSON(list(made_with = paste("R", getRversion(), "lme4", packageVersion("lme4"), "lmerTest", packageVersion("lmerTest")),
                       fits = out), digits = NA, auto_unbox = TRUE, pretty = TRUE), "expected/lmm_random_terms.json")
