# Reads a cohort from a Tractus server into data frames (needs the packages curl and jsonlite).
#   TRACTUS_PASSWORD=... Rscript read_cohort.R https://sim.example.org:8480 rex authority.pem [study]
library(curl)
asked <- commandArgs(trailingOnly = TRUE)
url <- paste0(sub("/$", "", asked[1]), "/api/v1")
handle <- new_handle(cainfo = asked[3])

sign_in <- function(name, password) {
  handle_setopt(handle, copypostfields = jsonlite::toJSON(list(name = name, password = password), auto_unbox = TRUE))
  handle_setheaders(handle, "Content-Type" = "application/json")
  answer <- curl_fetch_memory(paste0(url, "/session"), handle)
  stopifnot(answer$status_code == 200)
  handle_setopt(handle, httpget = TRUE)  # the handle keeps the cookie
}
bytes_of <- function(path) {
  answer <- curl_fetch_memory(paste0(url, path), handle)
  stopifnot(answer$status_code == 200)
  answer$content
}
table_of <- function(name, study = NA)
  read.csv(text = rawToChar(bytes_of(paste0("/export/", name, ".csv", if (!is.na(study)) paste0("?study=", curl_escape(study))))),
           na.strings = "", stringsAsFactors = FALSE)

# NumPy's .npy version 1.0 of doubles, row after row: 10 bytes, a header of stated length, the numbers.
samples_of <- function(trial, rate_Hz = 100) {
  bytes <- bytes_of(sprintf("/export/trials/%s/samples.npy?rate_Hz=%g", trial, rate_Hz))
  length <- readBin(bytes[9:10], "integer", size = 2, signed = FALSE, endian = "little")
  header <- rawToChar(bytes[11:(10 + length)])
  shape <- as.integer(regmatches(header, regexec("\\(([0-9]+), ([0-9]+)\\)", header))[[1]][2:3])
  matrix(readBin(bytes[-(1:(10 + length))], "double", n = prod(shape), size = 8, endian = "little"), nrow = shape[1], byrow = TRUE)
}

sign_in(asked[2], Sys.getenv("TRACTUS_PASSWORD"))
study <- if (length(asked) > 3) asked[4] else NA
trials <- table_of("trials", study)
scores <- table_of("scores", study)
dictionary <- table_of("dictionary")
cat(nrow(trials), "trials of", length(unique(trials$participant)), "participants,", nrow(scores), "scores\n")
if (nrow(trials) > 0) {
  samples <- samples_of(trials$trial[1])
  colnames(samples) <- dictionary$column[dictionary$table == trials$rig[1]]
  print(head(samples))
}
