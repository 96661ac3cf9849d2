"""How far networks are from held-out truth, beside plain models: figures, pages, and weights that state them."""
