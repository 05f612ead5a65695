# A cohort in a zip (tractus-cohort/1), and its arrays.

# NumPy's .npy format, version 1.0: a matrix, a row per sample.
parse_npy <- function(data, name) {
  if (length(data) < 128 || !identical(data[1:8], as.raw(c(0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0))))
    stop(name, ": not a .npy file of version 1.0", call. = FALSE)
  length <- readBin(data[9:10], "integer", 1, size = 2, signed = FALSE, endian = "little")
  head <- rawToChar(data[10 + seq_len(length)])
  if (!grepl("'<f8'", head, fixed = TRUE) || !grepl("'fortran_order': False", head, fixed = TRUE))
    stop(name, ": little-endian doubles row after row are expected", call. = FALSE)
  shape <- as.numeric(strsplit(sub(".*'shape': \\(([0-9]+), ([0-9]+)\\).*", "\\1 \\2", head), " ")[[1]])
  values <- if (prod(shape)) readBin(data[-seq_len(10 + length)], "double", prod(shape), size = 8, endian = "little") else numeric()
  if (length(values) != prod(shape)) stop(name, ": the array is cut short", call. = FALSE)
  matrix(values, shape[1], shape[2], byrow = TRUE)
}

#' A list: about, summary, trials, scores, dictionary, and samples, a function of a trial's pseudonym that reads its matrix: a cohort
#' may be larger than the memory.
read_cohort <- function(path) {
  files <- tryCatch(utils::unzip(path, list = TRUE)$Name, error = function(e) character(), warning = function(w) character())
  if (!"cohort.json" %in% files) stop(path, ": not a cohort of Tractus", call. = FALSE)
  # Each file by a connection of its own, so that nothing is unpacked to the disk.
  bytes_of <- function(name, size = utils::unzip(path, list = TRUE)$Length[files == name]) {
    connection <- unz(path, name, "rb")
    on.exit(close(connection))
    readBin(connection, "raw", size)
  }
  about <- jsonlite::fromJSON(text_of(bytes_of("cohort.json")))
  if (!identical(about$format, "tractus-cohort/1"))
    stop(path, ": format ", about$format, ", expected tractus-cohort/1", call. = FALSE)
  dictionary <- parse_dictionary(text_of(bytes_of("dictionary.csv")))
  table <- function(name) parse_table(text_of(bytes_of(paste0(name, ".csv"))), texts_of(dictionary, name))
  with_samples <- sub("^samples/(.*)\\.npy$", "\\1", grep("^samples/", files, value = TRUE))
  list(about = about, summary = table("summary"), trials = table("trials"), scores = table("scores"), dictionary = dictionary,
       trials_with_samples = sort(with_samples), samples = function(trial) {
         if (!trial %in% with_samples) stop("trial ", trial, ": this export has no samples of it", call. = FALSE)
         name <- paste0("samples/", trial, ".npy")
         parse_npy(bytes_of(name), name)
       })
}
