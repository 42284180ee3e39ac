"""Reports of `slipgym study`: one page with figures and videos."""
