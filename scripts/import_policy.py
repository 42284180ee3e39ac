"""The command `slipgym import-policy`."""

from policies.console import run

if __name__ == "__main__":
    run("import_policy")
