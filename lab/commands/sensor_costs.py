"""The sub-command sensor-costs, see `lab.sensor_costs`."""

from lab.commands.options import application
from lab.sensor_costs import main

app = application()
app.command()(main)
