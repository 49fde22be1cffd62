"""What benchmarks of diagnoses share: cases that are answered each into its own file, and figures against goals."""
