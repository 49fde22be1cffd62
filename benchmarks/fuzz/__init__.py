"""Damaged files by the thousand: each is read, or refused in one line, in little time and memory."""
