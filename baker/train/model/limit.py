"""What may be shown of a displacement, and how far it may swing (runtime/tissue/modes/guard.hpp)."""
import torch

FREE_SHARE = 0.6  # of the limit: up to it a displacement is left alone


def limit_share(largest, limit):
    """What to show a displacement with whose largest vector is so long: 1 up to FREE_SHARE of its limit, which it then
    approaches smoothly. Tensors of one shape, metres; a limit may be infinite."""
    limited = torch.isfinite(limit) & (largest > FREE_SHARE * limit)
    reach = torch.where(limited, limit, torch.ones_like(limit))  # of others any number will do
    beyond = (largest - FREE_SHARE * reach) / ((1 - FREE_SHARE) * reach)
    shown = FREE_SHARE * reach + (1 - FREE_SHARE) * reach * beyond.tanh()
    return torch.where(limited, shown / largest.clamp(min=1e-12), torch.ones_like(largest))


def _share(limit, u):
    squared = u.square().sum(-1).amax(1)
    largest = squared.clamp(min=1e-24).sqrt()
    wide = limit.view(-1, *[1] * (largest.dim() - 1)).expand_as(largest)
    return limit_share(largest, wide)


def within(limit, u):
    """u (R, n, ..., 3) as it is shown; limit (R,), metres."""
    return u * _share(limit, u)[:, None, ..., None]


def swing_share(limit, u):
    """(R, ...): what all that goes on from u (R, n, ..., 3) is held with: 1 up to the limit."""
    return _share(limit / FREE_SHARE, u)
