"""The loop in a browser, on loopback: drop recordings in, try effects, diagnose, add. Needs the extra `lab`."""
