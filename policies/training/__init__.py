"""Training of policies with Stable-Baselines3: configuration, checkpoints, runs side by side.

Nothing here is imported by `import policies`; torch loads when a run begins.
"""
