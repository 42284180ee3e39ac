"""The laboratory's sub-commands of `slipgym`, a file each; `slipgym --help` shows them in a clone."""

COMMANDS = {
    "benchmark-parts": "Measure what the parts of a step and a first use cost.",
    "cards": "Print what each learned policy solves, and where.",
    "closed-loop": "Rank the estimators in the loop of a controller.",
    "compare-engines": "Compare the planar engine with PyBullet.",
    "compare-estimators": "Compare the estimators on recorded episodes.",
    "compare-simulators": "Compare the contact with other simulators.",
    "delays": 'Print "adaptive" in stick-slip with late velocities.',
    "estimator-costs": "Print what an update of each estimator costs.",
    "fuzz": "Print errors of estimators in independent worlds.",
    "hidden-grippers": "Print how often the intervals of identify hold.",
    "imperfections": "Print what each imperfection of the sensors costs.",
    "jumps": "Print how soon mu_c is right after friction jumps.",
    "live-bars": "Measure slipgym live under faults of its readings.",
    "pushes": "Compare the estimators on real pushes of a block.",
    "rank": "Compare the order of returns with that of success.",
    "reproduce": "Reproduce the paper's analyses.",
    "seeds": "Print what several seeds learn from nothing.",
    "sensor-bounds": "Print what the sensors of a gripper can say of friction.",
    "sensor-costs": "Print what the sensors of a gripper cost controllers.",
    "ship": "Add trained policies to the pretrained ones.",
    "study-report": "Write the report of a study as one page.",
    "train-estimator": 'Train the network of the estimator "gru".',
    "validate-parts": "Check steps, engines, patches, tilt and soft pads.",
    "validate-real": "Compare surfaces and estimators with real data.",
}
"""Name of each sub-command and its line of help."""
