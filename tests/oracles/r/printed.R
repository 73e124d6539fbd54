# The printed numbers as texts, and what rounding leaves open.

# the few kinds of line that published.toml has
read_paper <- function(path) {
  paper <- list(measures = list(), singles = list())
  place <- NULL
  for (line in readLines(path, encoding = "UTF-8")) {
    line <- trimws(sub("\\s#.*$|^#.*$", "", line))
    if (line == "") next
    if (grepl("^\\[\\[", line)) {
      name <- gsub("[][]", "", line)
      list_name <- paste0(name, "s")
      paper[[list_name]] <- c(paper[[list_name]], list(list()))
      place <- c(list_name, length(paper[[list_name]]))
    } else if (grepl("^\\[", line)) {
      place <- gsub("[][]", "", line)
      paper[[place]] <- list()
    } else {
      key <- trimws(sub("=.*$", "", line))
      value <- value_of(trimws(sub("^[^=]*=", "", line)))
      if (length(place) == 1) {
        paper[[place]][[key]] <- value
      } else {
        paper[[place[1]]][[as.integer(place[2])]][[key]] <- value
      }
    }
  }
  paper
}

value_of <- function(text) {
  if (grepl("^\\{", text)) {
    parts <- regmatches(text, gregexpr("[A-Za-z_]+ = (\"[^\"]*\"|[^,} ]+)", text))[[1]]
    values <- lapply(sub("^[^=]*= ", "", parts), value_of)
    return(setNames(values, sub(" =.*$", "", parts)))
  }
  if (grepl("^\\[", text)) return(regmatches(text, gregexpr("(?<=\")[^\",]+(?=\")", text, perl = TRUE))[[1]])
  gsub("\"", "", text)
}

half <- function(text) 0.5 * 10^-nchar(sub("^[^.]*\\.?", "", text))
low <- function(text) as.numeric(text) - half(text)
high <- function(text) as.numeric(text) + half(text)
fits <- function(value, text) abs(value - as.numeric(text)) <= half(text) + 1e-9

# whether some p in [from, to] is printed so
prints_as <- function(text, from, to) {
  if (grepl("^<", text)) return(from < as.numeric(sub("<", "", text)))
  from <= high(text) && to >= low(text)
}

# F = n d² / (s1² + s2² − 2 r s1 s2), solved for r
r_given <- function(m1, s1, m2, s2, f) (s1^2 + s2^2 - N * (m1 - m2)^2 / f) / (2 * s1 * s2)

r_of <- function(m) {
  v <- as.numeric(c(m$standard$mean, m$standard$sd, m$dynamic$mean, m$dynamic$sd, m$F))
  r_given(v[1], v[2], v[3], v[4], v[5])
}

r_range <- function(m) {
  texts <- list(m$standard$mean, m$standard$sd, m$dynamic$mean, m$dynamic$sd, m$F)
  grid <- expand.grid(lapply(texts, function(t) c(low(t), high(t))))
  range(r_given(grid[, 1], grid[, 2], grid[, 3], grid[, 4], grid[, 5]))
}
