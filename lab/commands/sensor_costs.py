"""The sub-command sensor-costs, see `lab.sensor_costs`."""

from lab.commands.options import application
from lab.sensor_costs import main

EPILOG = """
Examples:\n
\b
  slipgym sensor-costs --episodes 200
  slipgym sensor-costs --task Hold --preset wrist
"""
app = application()
app.command(epilog=EPILOG)(main)
