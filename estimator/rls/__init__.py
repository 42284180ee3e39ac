"""Recursive least squares for mu_c and r, stick-slip events for mu_s."""
