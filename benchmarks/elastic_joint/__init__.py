"""Position servos with a soft transmission, whose models are rigid and make up for it by a delay."""
