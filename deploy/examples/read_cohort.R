#!/usr/bin/env Rscript
# Reads a cohort that GET /api/v1/export/cohort.zip gave (tractus-cohort/1) with nothing but R itself.
#
#     Rscript read_cohort.R cohort.zip
#
# Prints one line a table and one a trial's samples. In a session: cohort <- read_cohort("cohort.zip"); then cohort$trials and
# cohort$scores are data frames, cohort$samples a list of matrices by trial.

# A .npy file of version 1.0: a matrix, a row per sample.
read_npy <- function(path) {
  file <- file(path, "rb")
  on.exit(close(file))
  magic <- readBin(file, "raw", 8)
  if (!identical(magic, as.raw(c(0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0)))) stop(path, ": not a .npy file of version 1.0")
  length <- readBin(file, "integer", 1, size = 2, signed = FALSE, endian = "little")
  head <- rawToChar(readBin(file, "raw", length))
  if (!grepl("'<f8'", head) || !grepl("'fortran_order': False", head)) stop(path, ": little-endian doubles row after row are expected")
  shape <- as.integer(strsplit(sub(".*'shape': \\(([0-9]+), ([0-9]+)\\).*", "\\1 \\2", head), " ")[[1]])
  matrix(readBin(file, "double", prod(shape), size = 8, endian = "little"), shape[1], shape[2], byrow = TRUE)
}

read_cohort <- function(path) {
  folder <- tempfile("cohort")
  on.exit(unlink(folder, recursive = TRUE))
  utils::unzip(path, exdir = folder)
  about <- paste(readLines(file.path(folder, "cohort.json"), warn = FALSE), collapse = "")
  if (!grepl("tractus-cohort/1", about, fixed = TRUE)) stop(path, ": not a tractus-cohort/1")
  table <- function(name) read.csv(file.path(folder, name), na.strings = "", stringsAsFactors = FALSE, encoding = "UTF-8")
  files <- list.files(file.path(folder, "samples"), "\\.npy$", full.names = TRUE)
  list(trials = table("trials.csv"), scores = table("scores.csv"), dictionary = table("dictionary.csv"),
       samples = stats::setNames(lapply(files, read_npy), sub("\\.npy$", "", basename(files))))
}

if (sys.nframe() == 0) {
  arguments <- commandArgs(trailingOnly = TRUE)
  if (length(arguments) != 1) stop("usage: read_cohort.R cohort.zip")
  cohort <- read_cohort(arguments[1])
  cat(sprintf("trials %d participants %d scores %d\n", nrow(cohort$trials), length(unique(cohort$trials$participant)), nrow(cohort$scores)))
  for (trial in sort(names(cohort$samples))) {
    m <- cohort$samples[[trial]]
    cat(sprintf("samples %s rows %d columns %d last_t_s %.6f\n", trial, nrow(m), ncol(m), m[nrow(m), 1]))
  }
}
