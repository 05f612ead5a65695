# A Tractus server, asked with a personal token.

#' @param token personal token; without it, the environment variable TRACTUS_TOKEN
tractus_server <- function(url, token = Sys.getenv("TRACTUS_TOKEN")) {
  token <- trimws(token)
  if (!nzchar(token) || grepl("[^!-~]", token))
    stop("no token: pass token or set the environment variable TRACTUS_TOKEN; the account page makes tokens", call. = FALSE)
  if (!grepl("^https?://", url)) stop(url, ": an address beginning with https:// (or http://) is expected", call. = FALSE)
  structure(list(url = sub("/+$", "", url), token = token), class = "tractus_server")
}

# Shows the address, never the token.
print.tractus_server <- function(x, ...) cat("Tractus server at", x$url, "\n")

address_of <- function(server, path, query = list()) {
  query <- query[!vapply(query, is.null, TRUE)]
  words <- paste0(names(query), "=", vapply(query, function(one) curl::curl_escape(as.character(one)), ""), collapse = "&")
  paste0(server$url, "/api/v1", path, if (length(query)) paste0("?", words) else "")
}

# For samples at 100 Hz a server reads every trial before its first byte: 15 minutes of silence are waited for.
handle_of <- function(server, method = "GET", body = NULL, headers = list()) {
  handle <- curl::new_handle(customrequest = method, connecttimeout = 30, low_speed_limit = 1, low_speed_time = 900)
  headers$Authorization <- paste("Bearer", server$token)
  if (!is.null(body)) {
    text <- jsonlite::toJSON(body, auto_unbox = TRUE, null = "null", digits = NA)
    curl::handle_setopt(handle, postfields = as.character(text))
    headers$`Content-Type` <- "application/json"
  }
  do.call(curl::handle_setheaders, c(list(handle), headers))
  handle
}

refuse <- function(method, path, status, content) {
  said <- tryCatch(jsonlite::fromJSON(rawToChar(content))$error, error = function(e) NULL)
  advice <- switch(as.character(status), "401" = "; the token is unknown, revoked or expired: make a new one on the account page",
                   "403" = "; ask an administrator if you need this", "")
  condition <- simpleError(paste0(method, " ", path, ": ", if (is.null(said)) paste("HTTP status", status) else said, advice))
  condition$status <- status
  class(condition) <- c("tractus_refusal", class(condition))
  stop(condition)
}

answer_of <- function(server, method, path, query = list(), body = NULL) {
  answer <- tryCatch(curl::curl_fetch_memory(address_of(server, path, query), handle_of(server, method, body)),
                     error = function(e) stop(server$url, " cannot be reached: ", conditionMessage(e), call. = FALSE))
  if (answer$status_code >= 400) refuse(method, path, answer$status_code, answer$content)
  answer$content
}

text_of <- function(content) {
  text <- rawToChar(content)
  Encoding(text) <- "UTF-8"
  text
}

#' The answer of a route as lists; path without /api/v1.
tractus_ask <- function(server, method, path, query = list(), body = NULL) {
  content <- answer_of(server, method, path, query, body)
  if (length(content)) jsonlite::fromJSON(text_of(content), simplifyVector = FALSE)
}

# Columns of texts as the dictionary or `texts` says; the others are numbers.
parse_table <- function(text, texts) {
  names <- names(utils::read.csv(text = text, nrows = 0, check.names = FALSE))
  classes <- ifelse(names %in% texts, "character", "numeric")
  utils::read.csv(text = text, na.strings = "", colClasses = classes, check.names = FALSE, encoding = "UTF-8")
}

texts_of <- function(dictionary, table) dictionary$column[dictionary$table == table & dictionary$type == "text"]

parse_dictionary <- function(text) utils::read.csv(text = text, colClasses = "character", encoding = "UTF-8")

export_table <- function(server, name, study) {
  dictionary <- parse_dictionary(text_of(answer_of(server, "GET", "/export/dictionary.csv")))
  text <- text_of(answer_of(server, "GET", paste0("/export/", name, ".csv"), list(study = study)))
  parse_table(text, texts_of(dictionary, name))
}

where <- function(table, wanted) {
  for (name in names(wanted)) table <- table[!is.na(table[[name]]) & table[[name]] == wanted[[name]], ]
  table
}

#' All studies, as the server lists them.
tractus_studies <- function(server) {
  all <- list()
  cursor <- NULL
  repeat {
    page <- tractus_ask(server, "GET", "/studies", list(cursor = cursor))
    all <- c(all, page$studies)
    cursor <- page$`next`
    if (is.null(cursor)) return(all)
  }
}

tractus_summary <- function(server, study = NULL) export_table(server, "summary", study)
#' @param ... values of columns, for example rig = "probing"
tractus_trials <- function(server, study = NULL, ...) where(export_table(server, "trials", study), list(...))
tractus_scores <- function(server, study = NULL, ...) where(export_table(server, "scores", study), list(...))

#' A row per scored trial with its scores as columns, as analyses use it.
tractus_cohort_table <- function(server, study = NULL) {
  text <- text_of(answer_of(server, "GET", "/cohort/table", list(study = study)))
  parse_table(text, c("trial", "participant", "study", "cohort", "level", "date", "case", "rig"))
}

#' A matrix, a row per sample. rate_Hz = 0: every sample.
tractus_samples <- function(server, trial, rate_Hz = 100) {
  path <- paste0("/export/trials/", curl::curl_escape(trial), "/samples.npy")
  parse_npy(answer_of(server, "GET", path, list(rate_Hz = rate_Hz)), paste("trial", trial))
}

#' Calls what(trial, samples) for one trial after the other: the memory is that of one trial. A trial whose participant did not
#' consent to samples of this rate is passed over.
tractus_each_trial <- function(server, what, study = NULL, rate_Hz = 100, ...) {
  trials <- tractus_trials(server, study, ...)
  out <- list()
  for (i in seq_len(nrow(trials))) {
    samples <- tryCatch(tractus_samples(server, trials$trial[i], rate_Hz),
                        tractus_refusal = function(e) if (e$status %in% c(403, 404)) NULL else stop(e))
    if (!is.null(samples)) out[[trials$trial[i]]] <- what(trials[i, ], samples)
  }
  out
}

#' Downloads a zip of the tables and, for the tiers reduced and full, the samples to the file `to`, which appears when it is whole;
#' read_cohort reads it. Goes on where a connection broke, and begins anew when the cohort is another one by then.
tractus_cohort <- function(server, to, study = NULL, tier = "metrics") {
  part <- paste0(to, ".part")
  on.exit(unlink(part))
  address <- address_of(server, "/export/cohort.zip", list(study = study, tier = tier))
  tag <- NULL
  stalled <- 0
  done <- 0
  repeat {
    Sys.sleep(stalled)
    headers <- if (done > 0) list(Range = sprintf("bytes=%.0f-", done), `If-Range` = tag) else list()
    came <- take_rest(address, handle_of(server, headers = headers), part)
    if (is.null(came$failure)) break
    if (!is.null(came$tag)) tag <- came$tag
    # Without a tag nothing says that what follows belongs to what has come.
    if (is.null(tag) || stalled == 5) stop(to, ": the connection broke: ", came$failure, call. = FALSE)
    now <- if (file.exists(part)) file.size(part) else 0
    stalled <- if (now == done) stalled + 1 else 0
    done <- now
  }
  if (!file.rename(part, to)) stop(to, ": cannot be written", call. = FALSE)
  invisible(to)
}

# Puts what comes into the file, behind what is there if the server says so. Returns the entity tag, and what broke.
take_rest <- function(address, handle, part) {
  file <- NULL
  refusal <- raw()
  take <- function(bytes) {
    status <- curl::handle_data(handle)$status_code
    if (status >= 400) {
      refusal <<- c(refusal, bytes)
    } else {
      if (is.null(file)) file <<- base::file(part, if (status == 206) "ab" else "wb")
      writeBin(bytes, file)
    }
  }
  failure <- tryCatch({ curl::curl_fetch_stream(address, take, handle); NULL }, error = conditionMessage)
  if (!is.null(file)) close(file)
  answer <- curl::handle_data(handle)
  if (answer$status_code >= 400) refuse("GET", "/export/cohort.zip", answer$status_code, refusal)
  list(tag = curl::parse_headers_list(answer$headers)$etag, failure = failure)
}

tractus_plans <- function(server) tractus_ask(server, "GET", "/cohort/plans")$plans

tractus_lock_plan <- function(server, plan, study = NULL, data_seen = FALSE) {
  body <- list(plan = plan, data_seen = data_seen)
  body$study <- study
  tractus_ask(server, "POST", "/cohort/plans", body = body)
}

#' Runs a locked plan and waits; returns the analysis with its result.
tractus_run_plan <- function(server, plan_id, snapshot = NULL) {
  body <- list(plan = plan_id)
  body$snapshot <- snapshot
  analysed(server, body)
}

#' Runs one method without a plan (see `tractus stats`) and waits.
tractus_analyse <- function(server, method, formula, study = NULL, ...) {
  body <- list(method = method, formula = formula)
  if (...length()) body$options <- list(...)
  body$study <- study
  analysed(server, body)
}

#' Stops a run that is queued or running; one that is done stays as it is.
tractus_stop_analysis <- function(server, analysis_id) {
  tractus_ask(server, "POST", paste0("/cohort/analyses/", analysis_id, "/stop"))
}

analysed <- function(server, body) {
  run <- tractus_ask(server, "POST", "/cohort/analyses", body = body)
  id <- run$id
  withCallingHandlers(repeat {
    run <- tractus_ask(server, "GET", paste0("/cohort/analyses/", id))
    if (!run$state %in% c("queued", "running")) break
    Sys.sleep(0.2)
  }, interrupt = function(condition) tractus_stop_analysis(server, id))
  if (run$state == "cancelled") stop("the analysis was ", run$error, call. = FALSE)
  if (run$state != "done") stop("the analysis failed: ", run$error, call. = FALSE)
  run
}
