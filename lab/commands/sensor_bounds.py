"""The sub-command sensor-bounds, see `lab.sensor_bounds`."""

from lab.commands.options import application
from lab.sensor_bounds import main

app = application()
app.command()(main)
