"""Real data of others: what limit surfaces, estimators and their slip decision say of it (docs/real_data.md)."""
