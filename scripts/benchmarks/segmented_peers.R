# Reads cases (name, x, y, most breakpoints) from the folder given, prints one line each and number of breakpoints:
# name, breakpoints, sum of squares, seconds. R's segmented with its bootstrap restarts, from its own starts.
suppressMessages(library(segmented))
arguments <- commandArgs(trailingOnly = TRUE)
for (path in arguments[-1]) {
  points <- read.csv(path)
  for (count in seq_len(as.integer(arguments[1]))) {
    set.seed(1)
    begin <- proc.time()[["elapsed"]]
    squares <- tryCatch({
      fit <- suppressWarnings(segmented(lm(force ~ position, data = points), seg.Z = ~position, npsi = count,
                                        control = seg.control(n.boot = 20, seed = 1)))
      # It may return the line itself, or fewer breakpoints: that is its answer.
      sum(residuals(fit)^2)
    }, error = function(problem) NA)
    cat(basename(path), count, format(squares, digits = 15), proc.time()[["elapsed"]] - begin, "\n")
  }
}
