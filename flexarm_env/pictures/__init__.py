"""Presentation of results: numbers and sentences, figures, and the report page. Figures need the extra `plots`."""
