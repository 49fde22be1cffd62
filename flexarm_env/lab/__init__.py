"""The loop in a browser, on loopback: drop recordings in, play with effects, diagnose, add. Needs the extra `lab`."""
