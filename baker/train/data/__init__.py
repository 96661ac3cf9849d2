"""What is learned from: bodies, motions, their ground truth by sinew-bake truth, and batches of it."""
