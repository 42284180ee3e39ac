"""The command `slipgym` and its sub-commands, a file each.

A sub-command's file is imported when it is called: the help of all of them takes no packages.
"""
