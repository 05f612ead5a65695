# Trial files (.ttrial), formats tractus-trial/1 and /2, as trial-format.md describes them.

# Names, bytes of a number, number of components, and the field that the packed residual refers to.
fields_of <- function(rig) {
  if (identical(rig, "probing"))
    list(names = c("t_s", "x_m", "theta_rad", "speed_m_s", "turning_rad_s", "fz_N", "tz_Nm", "command_m_s", "command_Nm", "law_m_s",
                   "round_trip_s", "tick", "flags", "mode", "fault"),
         kinds = c("f8", "f8", "f8", rep("f4", 8), "u4", "u2", "u1", "u1"), counts = rep(1, 15), refers = c(law_m_s = "command_m_s"))
  else
    list(names = c("t_s", "p_VH_m", "q_VH", "force_N", "torque_Nm", "rendered_force_N", "rendered_torque_Nm", "deflection_m", "tick",
                   "iterations", "flags", "patches", "reserved"),
         kinds = c("f8", "f8", "f8", "f4", "f4", "f4", "f4", "f4", "u4", "u2", "u2", "u4", "u4"),
         counts = c(1, 3, 4, 3, 3, 3, 3, 2, 1, 1, 1, 1, 1),
         refers = c(rendered_force_N = "force_N", rendered_torque_Nm = "torque_Nm"))
}

bytes_in_kind <- function(kinds) as.integer(substring(kinds, 2))

# A row per number of a sample: name, kind, offset, bytes, offset that its packed residual refers to.
layout_of <- function(rig) {
  fields <- fields_of(rig)
  bytes <- bytes_in_kind(fields$kinds)
  starts <- stats::setNames(cumsum(c(0, (bytes * fields$counts)[-length(bytes)])), fields$names)
  rows <- lapply(seq_along(fields$names), function(i) {
    name <- fields$names[i]
    part <- seq_len(fields$counts[i])
    after <- if (name %in% names(fields$refers)) starts[[fields$refers[[name]]]] + (part - 1) * bytes[i] else NA
    data.frame(name = if (length(part) > 1) paste0(name, "_", part - 1) else name, kind = fields$kinds[i],
               offset = starts[[name]] + (part - 1) * bytes[i], bytes = bytes[i], after = after)
  })
  do.call(rbind, rows)
}

u32 <- function(data, at) sum(as.numeric(data[at + 1:4]) * 256^(0:3))

# Numbers of `bytes` bytes as columns of 16-bit limbs, lowest first: R has no unsigned 64-bit numbers.
carry <- function(limbs) {
  for (i in seq_len(ncol(limbs))) {
    over <- floor(limbs[, i] / 65536)
    limbs[, i] <- limbs[, i] - over * 65536
    if (i < ncol(limbs)) limbs[, i + 1] <- limbs[, i + 1] + over
  }
  limbs
}
limbs_from <- function(bytes) {  # matrix: a row per number, a column per byte
  low <- seq(1, ncol(bytes), 2)
  matrix(bytes[, low] + 256 * bytes[, low + 1], nrow(bytes))
}
bytes_from <- function(limbs) {
  out <- matrix(0, nrow(limbs), 2 * ncol(limbs))
  low <- seq(1, ncol(out), 2)
  out[, low] <- limbs %% 256
  out[, low + 1] <- floor(limbs / 256)
  out
}
running_sum <- function(limbs) {
  # Of at most 16 243 limbs below 2^16: exact in a double.
  carry(matrix(apply(limbs, 2, cumsum), nrow(limbs)))
}
zigzag_decoded <- function(z) {
  negative <- z[, 1] %% 2 == 1
  above <- cbind(z[, -1, drop = FALSE], 0)
  half <- floor(z / 2) + (above %% 2) * 32768
  half[negative, ] <- 65535 - half[negative, ]
  half
}

# @param before  bytes of the two samples before the block, a row each
unpacked <- function(content, count, layout, before) {
  planes <- matrix(as.numeric(content), count)
  out <- matrix(0, count, ncol(planes))
  column <- 1
  layout <- layout[layout$name != "fault", ]
  layout$bytes[layout$name == "mode"] <- 2  # mode and fault are one column
  for (i in seq_len(nrow(layout))) {
    bytes <- layout$offset[i] + seq_len(layout$bytes[i])
    residual <- zigzag_decoded(limbs_from(planes[, column + seq_along(bytes) - 1, drop = FALSE]))
    if (!is.na(layout$after[i])) {
      values <- carry(residual + limbs_from(out[, layout$after[i] + seq_along(bytes), drop = FALSE]))
    } else {
      earlier <- limbs_from(before[, bytes, drop = FALSE])
      # x_i - x_{i-1} runs on from the last step before the block: second - first, as second + not(first) + 1.
      step <- earlier[2, ] + 65535 - earlier[1, ]
      step[1] <- step[1] + 1
      residual[1, ] <- residual[1, ] + step
      steps <- running_sum(carry(residual))
      steps[1, ] <- steps[1, ] + earlier[2, ]
      values <- running_sum(carry(steps))
    }
    out[, bytes] <- bytes_from(values)
    column <- column + length(bytes)
  }
  out
}

# R reads zstd from 4.5 on; before, the program zstd does, once for all frames.
zstd_decompressed <- function(frames, sizes) {
  if (getRversion() >= "4.5.0") return(lapply(frames, memDecompress, type = "zstd"))
  if (!nzchar(Sys.which("zstd"))) stop("to read packed samples, install the program zstd or R 4.5", call. = FALSE)
  packed <- tempfile("trial")
  plain <- tempfile("trial")
  on.exit(unlink(c(packed, plain)))
  writeBin(unlist(frames), packed)
  status <- system2("zstd", c("-q", "-d", "-f", "-c", shQuote(packed)), stdout = plain)
  all <- readBin(plain, "raw", sum(sizes))
  if (status != 0 || length(all) != sum(sizes)) stop("packed samples cannot be unpacked", call. = FALSE)
  ends <- cumsum(sizes)
  Map(function(end, size) all[(end - size) + seq_len(size)], ends, sizes)
}

# The whole frames: a list of type and payload; a torn end is passed over.
frames_of <- function(data, path) {
  out <- list()
  at <- 16
  while (at + 20 <= length(data) && any(data[at + 1:20] != 0)) {
    length <- u32(data, at + 4)
    if (u32(data, at + 8) != length(out) || length > 2^20)
      stop(path, ": offset ", at, ": not a frame of a trial file", call. = FALSE)
    if (at + 20 + length > length(data)) break
    out[[length(out) + 1]] <- list(type = rawToChar(data[at + 1:4]), payload = data[at + 20 + seq_len(length)])
    at <- at + 20 + length
  }
  out
}

numbers_in <- function(bytes, layout) {
  flat <- function(columns) as.raw(t(bytes[, columns, drop = FALSE]))
  columns <- lapply(seq_len(nrow(layout)), function(i) {
    raw <- flat(layout$offset[i] + seq_len(layout$bytes[i]))
    switch(layout$kind[i], f8 = readBin(raw, "double", nrow(bytes), 8, endian = "little"),
           f4 = readBin(raw, "double", nrow(bytes), 4, endian = "little"),
           u4 = colSums(matrix(as.numeric(raw), 4) * 256^(0:3)),
           u2 = readBin(raw, "integer", nrow(bytes), 2, signed = FALSE, endian = "little"), u1 = as.integer(raw))
  })
  stats::setNames(as.data.frame(columns, optional = TRUE), layout$name)
}

#' A list: header, samples (a data frame, a row per sample, SI units), events, sealed (the end of the file is there and counts the
#' samples) and complete. Frames are checked by length and number; the file's checksums are not, which the server did on upload.
read_ttrial <- function(path) {
  if (!file.exists(path)) stop(path, ": there is no such file", call. = FALSE)
  data <- readBin(path, "raw", file.size(path))
  if (length(data) < 16 || !rawToChar(data[1:15]) %in% c("tractus-trial/1", "tractus-trial/2"))
    stop(path, ": not a trial file of Tractus", call. = FALSE)
  frames <- frames_of(data, path)
  types <- vapply(frames, `[[`, "", "type")
  if (!length(frames) || types[1] != "HEAD") stop(path, ": the file holds no whole header", call. = FALSE)
  json <- function(frame) jsonlite::fromJSON(text_of(frame$payload), simplifyVector = TRUE)
  header <- json(frames[[1]])
  layout <- layout_of(header$rig)
  width <- max(layout$offset + layout$bytes)
  packed <- which(types == "PACK")
  counts <- vapply(frames[packed], function(f) u32(f$payload, 0), 0)
  contents <- if (length(packed)) zstd_decompressed(lapply(frames[packed], function(f) f$payload[-(1:4)]), counts * width) else list()
  before <- matrix(0, 2, width)
  blocks <- list()
  for (i in which(types %in% c("PACK", "SAMP"))) {
    count <- u32(frames[[i]]$payload, 0)
    block <- if (types[i] == "PACK") unpacked(contents[[match(i, packed)]], count, layout, before)
             else matrix(as.numeric(frames[[i]]$payload[-(1:4)]), count, byrow = TRUE)
    if (ncol(block) != width) stop(path, ": a block of samples has another size than its number of samples", call. = FALSE)
    blocks[[length(blocks) + 1]] <- block
    before <- utils::tail(rbind(before, block), 2)
  }
  bytes <- if (length(blocks)) do.call(rbind, blocks) else matrix(0, 0, width)
  events <- lapply(frames[types == "EVNT"], json)
  seal <- frames[types == "SEAL"]
  sealed <- length(seal) == 1 && u32(seal[[1]]$payload, 0) == nrow(bytes)
  ended <- any(vapply(events, function(e) identical(e$kind, "end"), TRUE))
  list(header = header, samples = numbers_in(bytes, layout), events = events, sealed = sealed, complete = sealed && ended)
}
