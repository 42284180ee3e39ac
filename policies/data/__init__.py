"""Public data of real contacts: what there is, and how it comes onto this machine (docs/real_data.md)."""
