"""Emulators of patches (DeepEmulator): data, network, training, judgement."""
