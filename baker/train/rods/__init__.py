"""Networks that correct a rod's continued start (COPINGNet): data, network, training, judgement."""
