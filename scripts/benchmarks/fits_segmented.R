# Reads position and force from the file given: segmented regression with as many breakpoints as asked for. Prints the sum of
# squares, the seconds and the 95 % interval of the first breakpoint.
suppressMessages(library(segmented))
arguments <- commandArgs(trailingOnly = TRUE)
points <- read.csv(arguments[2])
set.seed(1)
begin <- proc.time()[["elapsed"]]
tryCatch({
  fit <- suppressWarnings(segmented(lm(force ~ position, data = points), seg.Z = ~position, npsi = as.integer(arguments[1]),
                                    control = seg.control(n.boot = 20, seed = 1)))
  seconds <- proc.time()[["elapsed"]] - begin
  ends <- tryCatch(confint(fit)[1, 2:3], error = function(problem) c(NA, NA))
  cat(format(sum(residuals(fit)^2), digits = 15), seconds, ends, "\n")
}, error = function(problem) cat("NA", proc.time()[["elapsed"]] - begin, "NA NA\n"))
