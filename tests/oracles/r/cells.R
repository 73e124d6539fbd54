# One value for each participant and cell: arrays [participant, ..., transparency].

# the participants of the whole study, also those without a row of this kind
people_of <- function(trials) sort(unique(trials$participant), method = "radix")

levels_in <- function(column, known) known[known %in% column]

# the mean (or another function) of `column` over a participant's rows of each cell
table_of <- function(rows, who, column, factors, f = mean) {
  rows <- rows[!is.na(rows[[column]]), ]
  for (name in names(factors)) rows <- rows[rows[[name]] %in% factors[[name]], ]
  by <- c(
    list(factor(rows$participant, who)),
    lapply(names(factors), function(name) factor(rows[[name]], factors[[name]]))
  )
  values <- tapply(rows[[column]], by, f)
  counts <- tapply(rows[[column]], by, length)
  counts[is.na(counts)] <- 0
  list(values = values, counts = counts, who = who, factors = factors)
}

# who has a value in every one of the cells given (all of them by default)
whole <- function(values) {
  flat <- matrix(values, nrow = dim(values)[1])
  rowSums(is.na(flat)) == 0
}

# which cells somebody lacks, as the report writes them: `unique × dynamic`
lacking <- function(cells) {
  flat <- matrix(cells$values, nrow = length(cells$who))
  names <- do.call(expand.grid, c(cells$factors, stringsAsFactors = FALSE))
  # the report names cells with the last factor running fastest
  order <- do.call(order, lapply(names(cells$factors), function(name) {
    match(names[[name]], cells$factors[[name]])
  }))
  said <- apply(names, 1, paste, collapse = " × ")
  out <- lapply(seq_along(cells$who), function(i) said[order][is.na(flat[i, order])])
  names(out) <- cells$who
  out[lengths(out) > 0]
}
