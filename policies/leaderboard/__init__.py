"""All estimators on the same records."""
