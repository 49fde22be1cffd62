"""The tests on the oldest and on the newest versions that pyproject.toml allows: `python -m benchmarks.versions`."""
