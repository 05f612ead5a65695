# Makes data/sim_logistic_*.csv, data/verbal_aggression.csv and expected/logistic_random_terms.json with lme4's glmer (nAGQ = 1):
#   Rscript logistic_random_terms.R     in this folder
# The deviance is glmer's own function of (theta, beta), its inner search taken to 1e-13, and then ln|L|^2 once more at the mode: glmer leaves it at
# the weights of the step before, which moves it by up to 1e-7. glmer's outer search ends early too, so that Newton's steps on numDeriv's derivatives
# follow; a conditional variance of 0 stays 0. Standard errors are of numDeriv's Hessian; those that glmer prints, of a Hessian by simple differences,
# stand beside them.
suppressMessages({library(lme4); library(numDeriv); library(jsonlite)})
tight <- glmerControl(optimizer = "bobyqa", tolPwrss = 1e-13, check.conv.singular = "ignore", check.conv.grad = "ignore", check.conv.hess = "ignore",
                      optCtrl = list(rhoend = 1e-9, maxfun = 1e5))

# Per random term its part of theta as a lower triangle.
triangles <- function(theta, cnms) {
  out <- list(); at <- 0
  for (k in lengths(cnms)) {
    block <- matrix(0, k, k); size <- k * (k + 1) / 2
    block[lower.tri(block, TRUE)] <- theta[at + seq_len(size)]; at <- at + size
    out <- c(out, list(block))
  }
  setNames(out, make.unique(names(cnms)))
}

at_the_mode <- function(devfun) {
  here <- environment(devfun)
  function(x) {
    devfun(x)
    here$pp$updateXwts(here$resp$sqrtWrkWt()); here$pp$updateDecomp()
    here$resp$Laplace(here$pp$ldL2(), here$pp$ldRX2(), here$pp$sqrL(1))
  }
}

described <- function(name, formula, data) {
  glmer_fit <- glmer(formula, data, binomial, control = tight)
  parts <- glFormula(formula, data, binomial, control = tight)
  devfun <- updateGlmerDevfun(do.call(mkGlmerDevfun, c(parts, list(control = tight))), parts$reTrms)
  lower <- environment(devfun)$lower; pp <- environment(devfun)$pp
  devfun <- at_the_mode(devfun)
  x <- unlist(getME(glmer_fit, c("theta", "beta"))); nt <- length(getME(glmer_fit, "theta"))
  edge <- c(lower[seq_len(nt)] == 0 & x[seq_len(nt)] < 1e-3, rep(FALSE, length(x) - nt))
  x[edge] <- 0
  f <- function(free) { at <- x; at[!edge] <- free; devfun(at) }
  for (k in 1:4) x[!edge] <- x[!edge] - solve(hessian(f, x[!edge]), grad(f, x[!edge]))
  h <- hessian(f, x[!edge]); beta_at <- tail(seq_len(nrow(h)), length(x) - nt)
  best <- devfun(x); b <- pp$b(1)
  cnms <- parts$reTrms$cnms; keys <- make.unique(names(cnms)); gp <- parts$reTrms$Gp
  first <- lapply(seq_along(cnms), function(i) b[gp[i] + seq_along(cnms[[i]])])
  levels <- lapply(seq_along(cnms), function(i) levels(parts$reTrms$flist[[names(cnms)[i]]])[1])
  lambda <- triangles(x[seq_len(nt)], cnms)
  points <- lapply(1:3, function(k) {
    theta <- x[seq_len(nt)] + runif(nt, 0.05, 0.3); beta <- x[-seq_len(nt)] + runif(length(x) - nt, -0.1, 0.1)
    list(lambda = lapply(triangles(theta, cnms), unname), beta = beta, deviance = devfun(c(theta, beta)))
  })
  cat(name, "largest |gradient|", max(abs(grad(f, x[!edge]))), "below glmer's end by", deviance_of(glmer_fit) - best, "\n")
  list(data = paste0("data/", name, ".csv"), formula = deparse1(formula), deviance = best, fixef = unname(x[-seq_len(nt)]),
       se = unname(sqrt(diag(2 * solve(h))[beta_at])), glmer_se = unname(sqrt(diag(as.matrix(vcov(glmer_fit))))),
       aic = best + 2 * length(x), singular = any(edge), covariances = lapply(lambda, function(l) l %*% t(l)),
       first_effects = setNames(first, keys), first_levels = setNames(levels, keys), points = points)
}
deviance_of <- function(fit) as.numeric(-2 * logLik(fit))

simulated <- function(seed, surgeons, scenarios, rows, slope_sd, between_sd = 1, trials = 1) {
  set.seed(seed)
  intercept <- rnorm(surgeons, 0, between_sd)
  slope <- slope_sd * (0.5 * intercept + rnorm(surgeons))
  bump <- rnorm(scenarios, 0, 0.6)
  who <- sample(surgeons, rows, TRUE); what <- sample(scenarios, rows, TRUE); trial <- sample(12, rows, TRUE)
  y <- rbinom(rows, trials, plogis(-0.8 + 0.15 * trial + intercept[who] + slope[who] * trial + bump[what]))
  data.frame(y, m = trials, trial, surgeon = sprintf("s%02d", who), scenario = sprintf("c%d", what), hospital = sprintf("h%d", who %% 6))
}
verbal <- with(VerbAgg, data.frame(y = as.integer(r2 == "Y"), m = 1L, trial = Anger, surgeon = id, scenario = as.integer(item)))

sets <- list(
  sim_logistic_1 = list(simulated(11, 20, 6, 400, 0), y / m ~ trial + (1 | surgeon) + (1 | scenario)),
  sim_logistic_2 = list(simulated(12, 30, 8, 900, 0.2), y / m ~ trial + (1 + trial | surgeon) + (1 | scenario)),
  sim_logistic_3 = list(simulated(13, 36, 4, 250, 0, 1, 6), y / m ~ trial + (1 | hospital) + (1 | hospital:surgeon)),
  sim_logistic_4 = list(simulated(14, 25, 5, 300, 0.2, 0.8, 10), y / m ~ trial + scenario + (0 + trial | surgeon) + (1 | surgeon)),
  sim_logistic_5 = list(simulated(16, 15, 5, 200, 0, 0), y / m ~ trial + (1 | surgeon) + (1 | scenario)),
  sim_logistic_6 = list(simulated(17, 12, 8, 400, 0.15, 1, 4), y / m ~ trial + (1 + trial | surgeon) + (1 + trial | scenario)),
  sim_logistic_7 = list(simulated(18, 6, 5, 150, 0), y / m ~ trial + (1 + trial | surgeon)),
  verbal_aggression = list(verbal, y / m ~ trial + (1 | surgeon) + (1 | scenario)))

dir.create("data", FALSE); out <- list()
for (name in names(sets)) {
  data <- sets[[name]][[1]]
  write.csv(data, paste0("data/", name, ".csv"), row.names = FALSE, quote = FALSE)
  rows <- data; for (column in c("surgeon", "scenario", "hospital")) if (column %in% names(rows)) rows[[column]] <- factor(rows[[column]])
  formula <- eval(parse(text = sub("y/m", "cbind(y, m - y)", deparse1(sets[[name]][[2]]), fixed = TRUE)))
  out[[name]] <- described(name, formula, rows)
}
writeLines(toJSON(list(made_with = paste("R", getRversion(), "lme4", packageVersion("lme4"), "numDeriv", packageVersion("numDeriv")), fits = out),
                  digits = NA, auto_unbox = TRUE, pretty = TRUE), "expected/logistic_random_terms.json")
