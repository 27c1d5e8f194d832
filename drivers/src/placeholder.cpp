// Replaced by the simulated devices.
