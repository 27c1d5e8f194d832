# What lme4 and glm make of the studies that `kerf_people_study oracle` printed: lines of JSON in, the same with theirs out.
suppressMessages({library(lme4); library(jsonlite)})

mixed <- function(row) {
  data <- as.data.frame(matrix(row$rows, ncol = 4, byrow = TRUE, dimnames = list(NULL, c("subject", "x", "k", "miss"))))
  fit <- glmer(cbind(k, miss) ~ x + (1 | subject), data, family = binomial(row$link), nAGQ = 25)
  b <- unname(fixef(fit)); sd <- as.data.frame(VarCorr(fit))$sdcor[1]
  # glmer's own log-likelihood with nAGQ > 1 is relative: the integral again, by integrate().
  p <- if (row$link == "probit") pnorm else plogis
  total <- 0
  for (subject in unique(data$subject)) {
    own <- data[data$subject == subject, ]
    value <- function(u) {
      eta <- b[1] + sd * u + b[2] * own$x
      sum(own$k * p(eta, log.p = TRUE) + own$miss * p(eta, lower.tail = FALSE, log.p = TRUE))
    }
    top <- optimize(function(u) value(u) - u^2 / 2, c(-6, 6), maximum = TRUE)$objective
    total <- total + top + log(integrate(Vectorize(function(u) exp(value(u) - u^2 / 2 - top) / sqrt(2 * pi)), -10, 10,
                                         rel.tol = 1e-11)$value)
  }
  list(kind = "mixed", threshold = -b[1] / b[2], slope = b[2], deviation = sd / b[2], log_likelihood = total)
}

ranking <- function(row) {
  data <- as.data.frame(matrix(row$rows, ncol = 5, byrow = TRUE, dimnames = list(NULL, c("subject", "i", "j", "k", "miss"))))
  items <- max(data$j)
  x <- sapply(1:items, function(item) (data$i == item) - (data$j == item))
  fit <- glm(cbind(data$k, data$miss) ~ x - 1, family = binomial)
  subjects <- unique(data$subject)
  n <- length(subjects)
  left_out <- sapply(subjects, function(subject) {
    others <- data$subject != subject
    coef(glm(cbind(data$k[others], data$miss[others]) ~ x[others, ] - 1, family = binomial))
  })
  errors <- sqrt((n - 1) / n * rowSums((left_out - coef(fit))^2))
  list(kind = "ranking", differences = unname(coef(fit)), errors = unname(errors))
}

for (line in readLines(con <- file("stdin"))) {
  row <- fromJSON(line)
  if (row$kind == "mixed") cat(toJSON(mixed(row), digits = NA, auto_unbox = TRUE), "\n", sep = "")
  if (row$kind == "ranking") cat(toJSON(ranking(row), digits = NA, auto_unbox = TRUE), "\n", sep = "")
}
