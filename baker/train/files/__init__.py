"""What every part of the trainer reads and writes files with."""
