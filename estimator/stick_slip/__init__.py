"""What the estimators share: contact gate, halt, stick-slip machine, buffer of force ratios, mu_s."""
