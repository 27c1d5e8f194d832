// Replaced by the fits.
