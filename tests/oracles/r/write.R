# Tables as CSV files: an empty cell, `undefined`, or fifteen digits.

as_text <- function(value) {
  if (is.character(value)) return(value)
  if (length(value) == 0) return("")
  if (is.na(value)) return("undefined")
  sprintf("%.15g", value)
}

quoted <- function(text) {
  ifelse(grepl("[,\"\n]", text), paste0("\"", gsub("\"", "\"\"", text), "\""), text)
}

write_rows <- function(rows, path) {
  columns <- names(rows[[1]])
  lines <- vapply(rows, function(row) {
    paste(quoted(vapply(columns, function(c) as_text(row[[c]]), "")), collapse = ",")
  }, "")
  con <- file(path, "wb")
  writeLines(enc2utf8(c(paste(columns, collapse = ","), lines)), con, useBytes = TRUE)
  close(con)
}

write_tables <- function(tables, out) {
  dir.create(out, showWarnings = FALSE, recursive = TRUE)
  for (name in names(tables)) {
    if (length(tables[[name]])) write_rows(tables[[name]], file.path(out, paste0(name, ".csv")))
  }
}
