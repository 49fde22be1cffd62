"""The control law under which a recording was made: stated in a file, checked against the recording, run in its replay."""
