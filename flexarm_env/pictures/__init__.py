"""What a person sees of a result: numbers and sentences, figures, and a page. Figures need the extra `plots`."""
