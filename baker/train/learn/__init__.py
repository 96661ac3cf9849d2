"""Trains one network on a data set."""
