#!/usr/bin/env Rscript
# Prints what is in a cohort: Rscript read_cohort.R cohort.zip (GET /api/v1/export/cohort.zip).
here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE)[1]))
# Or, once deploy/clients/r is installed: library(tractus)
for (file in list.files(file.path(here, "../clients/r/R"), full.names = TRUE)) source(file)

arguments <- commandArgs(trailingOnly = TRUE)
if (length(arguments) != 1) stop("usage: read_cohort.R cohort.zip")
cohort <- read_cohort(arguments[1])
cat(sprintf("trials %d participants %d scores %d\n", nrow(cohort$trials), length(unique(cohort$trials$participant)), nrow(cohort$scores)))
for (trial in cohort$trials_with_samples) {
  m <- cohort$samples(trial)
  cat(sprintf("samples %s rows %d columns %d last_t_s %.6f\n", trial, nrow(m), ncol(m), m[nrow(m), 1]))
}
