"""What a program costs a CPU, by its text alone: run time along the longest way, and memory."""
