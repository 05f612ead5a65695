# The rival: R's own functions on the same numbers, timed in R, printed with all digits.
# Rscript peer.R FOLDER ROWS NIST_FOLDER
args <- commandArgs(TRUE); folder <- args[1]; n <- as.integer(args[2]); nist <- args[3]
doubles <- function(name, count) readBin(file.path(folder, name), "double", count)
say <- function(key, values) cat(key, sprintf("%.17g", values), "\n")
# Processor time, as ours: R and we work in one thread each, and what else the machine does is nobody's merit.
spent <- function(work) sum(system.time(work)[c("user.self", "sys.self")])
least <- function(times, work) { best <- Inf; for (i in seq_len(times)) { gc(FALSE); best <- min(best, spent(r <<- work())) }; best }
if (n > 0) {
  x <- matrix(doubles("x.bin", 5 * n), n, 5); y <- doubles("y.bin", n); yr <- doubles("yr.bin", n)
  g <- factor(doubles("g.bin", n)); yg <- doubles("yg.bin", n)
  d <- data.frame(y = y, x)
  s <- least(7, function() lm(y ~ X1 + X2 + X3 + X4 + X5, d)); fit <- r
  sm <- summary(fit)$coefficients
  say("lm_s", s); say("lm", coef(fit)); say("lm_se", sm[, 2])
  if (requireNamespace("MASS", quietly = TRUE)) {
    d$y <- yr
    s <- least(2, function() MASS::rlm(y ~ X1 + X2 + X3 + X4 + X5, d, psi = MASS::psi.bisquare)); fit <- r
    say("rlm_s", s); say("rlm", coef(fit)); say("rlm_se", summary(fit)$coefficients[, 2])
  }
  d <- data.frame(y = yg, g = g)
  s <- least(5, function() summary(aov(y ~ g, d))); f <- r[[1]]
  say("aov_s", s); say("aov", c(f[1, 4], f[1, 5]))
}
# Certified problems: the numbers after the header of each file, as in the certificate.
rows <- function(path, from, to) { l <- readLines(path)[from:to]; do.call(rbind, lapply(strsplit(trimws(l), "[ \t]+"), as.numeric)) }
linear <- function(name, from, to, f) { m <- rows(file.path(nist, "linear", paste0(name, ".dat")), from, to); d <- as.data.frame(m); fit <- lm(f, d, tol = 1e-20); say(paste0("nist_", name), coef(fit)) }
poly <- function(k) as.formula(paste("V1 ~", paste(sprintf("I(V2^%d)", 1:k), collapse = " + ")))
try(linear("Norris", 61, 96, V1 ~ V2)); try(linear("Pontius", 61, 100, poly(2)))
try(linear("NoInt1", 61, 71, V1 ~ V2 - 1)); try(linear("NoInt2", 61, 63, V1 ~ V2 - 1))
try(linear("Longley", 61, 76, V1 ~ V2 + V3 + V4 + V5 + V6 + V7))
for (k in 1:5) try(linear(paste0("Wampler", k), 61, 81, poly(5)))
try(linear("Filip", 61, 142, poly(10)))
anova_file <- function(name) { m <- readLines(file.path(nist, "anova", paste0(name, ".dat"))); m <- m[61:length(m)]; m <- m[nzchar(trimws(m))]
  v <- do.call(rbind, lapply(strsplit(trimws(m), "[ \t]+"), as.numeric)); d <- data.frame(y = v[, 2], g = factor(v[, 1]))
  say(paste0("nist_", name), summary(aov(y ~ g, d))[[1]][1, 4]) }
for (name in c("SiRstv", "AtmWtAg", paste0("SmLs0", 1:9))) try(anova_file(name))
univariate <- function(name) { v <- scan(file.path(nist, "univariate", paste0(name, ".dat")), skip = 60, quiet = TRUE)
  say(paste0("nist_", name), c(mean(v), sd(v), acf(v, 1, plot = FALSE)$acf[2])) }
for (name in c("PiDigits", "Lottery", "Lew", "Mavro", "Michelso", paste0("NumAcc", 1:4))) try(univariate(name))
