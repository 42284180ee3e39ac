"""What the environments cost: measurements for scripts/benchmark.py; nothing else imports this."""
