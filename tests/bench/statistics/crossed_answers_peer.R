# The rival: lme4's glmer on the same answers, timed in R by processor time, printed with all digits.
# Rscript crossed_answers_peer.R FOLDER ROWS
# Of 10^6 answers Laplace's approximation takes longer than a bench may; there the modes are found at the optimum of theta alone (nAGQ = 0).
suppressMessages(library(lme4))
args <- commandArgs(TRUE); folder <- args[1]; n <- as.integer(args[2])
doubles <- function(name) readBin(file.path(folder, name), "double", n)
say <- function(key, values) cat(key, sprintf("%.17g", values), "\n")
d <- data.frame(y = doubles("y.bin"), trial = doubles("trial.bin"), surgeon = factor(doubles("surgeon.bin")), scenario = factor(doubles("scenario.bin")))
s <- system.time(fit <- glmer(y ~ trial + (1 | surgeon) + (1 | scenario), d, binomial, nAGQ = if (n > 200000) 0 else 1))
say("glmer_s", sum(s[c("user.self", "sys.self")]))
say("glmer", c(-2 * logLik(fit), attr(VarCorr(fit)$surgeon, "stddev"), attr(VarCorr(fit)$scenario, "stddev"), fixef(fit)))
