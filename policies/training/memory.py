"""Sets how long an LSTM layer remembers before it has learned anything."""

import torch
from torch import nn

from policies.training.algorithms import HORIZON


def remembering(layer: nn.LSTM, horizon: float = HORIZON) -> nn.LSTM:
    """Set the biases of a layer so that its units remember from 1 to `horizon` steps, at least 2.

    By C. Tallec and Y. Ollivier, Can recurrent neural networks warp time?, ICLR 2018. With the biases of
    torch, or a horizon of 2, a unit forgets half of what it holds in each step.
    """
    size = layer.hidden_size
    keeps = torch.log(1.0 + (horizon - 2.0) * torch.rand(size))
    of_layer = dict(layer.named_parameters())
    with torch.no_grad():
        of_layer["bias_ih_l0"].zero_()
        # input, forget, cell and output gate
        of_layer["bias_hh_l0"].copy_(torch.cat([-keeps, keeps, torch.zeros(2 * size)]))
    return layer
