"""`python -m slipgym` is the command `slipgym`."""

from policies.commands.front import main

if __name__ == "__main__":
    main()
