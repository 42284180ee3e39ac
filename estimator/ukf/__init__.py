"""An unscented Kalman filter on the logarithms of mu_c and r."""
