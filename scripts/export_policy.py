"""The command `slipgym export-policy`."""

from policies.console import run

if __name__ == "__main__":
    run("export_policy")
