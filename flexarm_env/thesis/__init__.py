"""The thesis reproduced: its claims, its figures, its misprints and what each of them changes."""
