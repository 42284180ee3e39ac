"""The sub-command sensor-bounds, see `lab.sensor_bounds`."""

from lab.commands.options import application
from lab.sensor_bounds import main

EPILOG = """
Examples:\n
\b
  slipgym sensor-bounds
  slipgym sensor-bounds --episodes 10
"""
app = application()
app.command(epilog=EPILOG)(main)
