# What R's metafor (rma.mv, rma.uni) and nlme say of the same estimates: Rscript metafor.R > metafor_values.h
suppressMessages({library(metafor); library(nlme)})

# REML by its definition.
loss <- function(variances, d) {
  V <- diag(d$s^2 + variances[2]) + variances[1] * outer(d$specimen, d$specimen, "==")
  P <- solve(V); W <- sum(P); mu <- sum(P %*% d$y) / W; r <- d$y - mu
  as.numeric(determinant(V)$modulus) + log(W) + sum(r * (P %*% r))
}
# Newton's steps on whole matrices: slopes tr(P D) - y'PDPy and expected curvatures tr(PDPD).
sharpened <- function(d, at) {
  D <- list(outer(d$specimen, d$specimen, "==") * 1, diag(nrow(d)))
  for (i in 1:2000) {
    V <- diag(d$s^2 + at[2]) + at[1] * D[[1]]
    Vi <- solve(V); P <- Vi - outer(rowSums(Vi), colSums(Vi)) / sum(Vi); Py <- P %*% d$y
    g <- sapply(D, function(x) sum(diag(P %*% x)) - sum(Py * (x %*% Py)))
    free <- at > 0 | g < 0
    H <- outer(1:2, 1:2, Vectorize(function(a, b) sum(diag(P %*% D[[a]] %*% P %*% D[[b]]))))
    step <- c(0, 0); step[free] <- solve(H[free, free, drop = FALSE], g[free])
    next_at <- pmax(0, at - step)
    if (max(abs(next_at - at)) < 1e-15) break
    at <- next_at
  }
  stopifnot(loss(at, d) <= loss(pmax(at * 1.01, 1e-6), d), loss(at, d) <= loss(at * 0.99, d))
  at
}

set.seed(24)
drawer <- function(counts, between, within, errors) {
  specimen <- rep(seq_along(counts), counts)
  s <- rep_len(errors, length(specimen))
  y <- round(2 + between * rnorm(length(counts))[specimen] + within * rnorm(length(specimen)) + s * rnorm(length(specimen)), 4)
  data.frame(specimen = specimen, y = y, s = s)
}
drawers <- list(
  balanced = drawer(rep(3, 4), 0.3, 0.1, 0.05),
  unbalanced = drawer(c(1, 4, 2, 3, 2), 0.3, 0.15, c(0.03, 0.1, 0.05, 0.2)),
  two_specimens = drawer(c(2, 3), 0.2, 0.1, c(0.04, 0.08)),
  many = drawer(c(3, 2, 5, 1, 4, 2, 6, 3), 0.2, 0.2, c(0.02, 0.15, 0.07)),
  without_errors = drawer(c(2, 4, 3, 2), 0.3, 0.1, 0),
  # Specimens that are more alike than their recordings: no spread between them.
  alike = data.frame(specimen = rep(1:3, each = 2), y = c(1.9, 2.11, 1.92, 2.1, 2.13, 1.89), s = 0.05),
  once_each = drawer(rep(1, 6), 0.3, 0, c(0.05, 0.15, 0.1)))

num <- function(x) formatC(x, digits = 15, format = "g", width = 1)
cat("#pragma once\n\n#include <string>\n#include <vector>\n\nnamespace kerf::population {\n\n")
cat("struct Recorded {\n  int specimen;\n  double value, error;\n};\n\n")
cat("/// Made by metafor.R. Variances are t_b^2 and t_w^2; the standard error is Hartung and Knapp's over specimens.\n")
cat("struct PeerValues {\n  std::string name;\n  std::vector<Recorded> recordings;\n  double mean, between, within, standard_error;\n  double between_lower, between_upper;  ///< of t_b, by Q-profile; 0 where the peer has none\n};\n\n")
cat("inline std::vector<PeerValues> peer_values() {\n  return {\n")
for (name in names(drawers)) {
  d <- drawers[[name]]
  d$recording <- seq_len(nrow(d))
  single <- !any(duplicated(d$specimen))
  limits <- c(0, 0)
  if (single) {
    fit <- rma.uni(y, sei = s, data = d, method = "REML", control = list(threshold = 1e-12, maxiter = 1000))
    between <- fit$tau2; within <- 0
    limits <- confint(fit, control = list(tol = 1e-12))$random["tau", 2:3]
  } else if (all(d$s == 0)) {
    fit <- lme(y ~ 1, random = ~1 | specimen, data = d, method = "REML",
               control = lmeControl(opt = "nlminb", msTol = 1e-14, tolerance = 1e-12, msMaxIter = 1000))
    between <- as.numeric(VarCorr(fit)[1, 1]); between <- as.numeric(getVarCov(fit)); within <- fit$sigma^2
  } else {
    # metafor's own search ends at about 1e-4: its likelihood, written with whole matrices, is sharpened from there.
    fit <- rma.mv(y, s^2, random = ~1 | specimen/recording, data = d, method = "REML")
    best <- sharpened(d, pmax(fit$sigma2, 1e-10))
    stopifnot(abs(best - fit$sigma2) < 1e-3 * max(fit$sigma2))
    between <- best[1]; within <- best[2]
  }
  weights <- 1 / (d$s^2 + within)
  total <- tapply(weights, d$specimen, sum)
  means <- tapply(weights * d$y, d$specimen, sum) / total
  over <- rma.uni(as.numeric(means), vi = as.numeric(1 / total), tau2 = between, test = "knha")
  cat(sprintf("      {\"%s\",\n       {%s},\n       %s, %s, %s, %s, %s, %s},\n", name,
              paste(sprintf("{%d, %s, %s}", d$specimen, num(d$y), num(d$s)), collapse = ", "),
              num(as.numeric(over$beta)), num(between), num(within), num(over$se), num(limits[1]), num(limits[2])))
}
cat("  };\n}\n\n}  // namespace kerf::population\n")
