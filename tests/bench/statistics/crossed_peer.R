# The rival: lme4's lmer on the same numbers, timed in R by processor time, printed with all digits.
# Rscript crossed_peer.R FOLDER ROWS
suppressMessages(library(lme4))
args <- commandArgs(TRUE); folder <- args[1]; n <- as.integer(args[2])
doubles <- function(name) readBin(file.path(folder, name), "double", n)
say <- function(key, values) cat(key, sprintf("%.17g", values), "\n")
d <- data.frame(y = doubles("y.bin"), trial = doubles("trial.bin"), surgeon = factor(doubles("surgeon.bin")), scenario = factor(doubles("scenario.bin")))
s <- system.time(fit <- lmer(y ~ trial + (1 | surgeon) + (1 | scenario), d, control = lmerControl(calc.derivs = FALSE)))
say("lmer_s", sum(s[c("user.self", "sys.self")]))
say("lmer", c(REMLcrit(fit), sigma(fit)^2, fixef(fit), sqrt(diag(as.matrix(vcov(fit))))[2]))
