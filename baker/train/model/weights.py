"""Weights files: names and metadata of baker/pack/network/network_pack.hpp and runtime/pack/format.hpp
(NetworkRecord)."""
import numpy as np
import torch

from ..files.safetensors import BadData, load, save
from .alt_conv_lstm import AltConvLSTM, ModelOptions
from .inputs import INPUT_WIDTH, ORDER, Scaling
from .vanilla import FORMS, ConvLSTM

BASE = "modal_2"  # of whole bodies' modes; weights on another are refused


def _join(numbers):
    return ",".join(f"{float(n):.9g}" for n in numbers)


def weights_metadata(options, scaling, rate_hz, extra):
    """extra: name -> value, kept and shown by `sinew-bake info`."""
    return {
        "sinew.model": "alt_conv_lstm",
        "sinew.version": "1",
        "channels": ",".join(map(str, options.channels)),
        "rate_hz": f"{rate_hz:g}",
        "inputs": ",".join(ORDER),
        "input_scales": _join(scaling.scale[k] for k in ORDER),
        "envelope": _join(scaling.envelope[k] for k in ORDER),
        "frame": "bent",
        "base": "none" if "base" in scaling.without else BASE,
        **({"without": ",".join(scaling.without)} if scaling.without else {}),
        "length_unit": f"{scaling.length_unit:.9g}",
        "output_scale": f"{options.output_scale:.9g}",
        "output_leak": f"{options.output_leak:.9g}",
        "hidden_leak": f"{options.hidden_leak:.9g}",
        "state_clamp": f"{options.state_clamp:.9g}",
        **extra,
    }


def save_weights(path, model, scaling, rate_hz, extra):
    tensors = {k: v.detach().cpu().float().numpy() for k, v in model.state_dict().items()}
    save(path, tensors, weights_metadata(model.options, scaling, rate_hz, extra))


def read_number(path, metadata, key, fallback):
    try:
        return float(metadata.get(key, fallback))
    except ValueError:
        raise BadData(
            f"{path}: metadata {key} is '{metadata[key]}', not a number; export the weights again"
        ) from None


def _numbers(path, metadata, key, kind=float, count=None):
    """The numbers of a list; of `count` where it is given."""
    try:
        numbers = [kind(v) for v in metadata[key].split(",")]
        if count in (None, len(numbers)):
            return numbers
    except (KeyError, ValueError):
        pass
    found = f"'{metadata[key]}'" if key in metadata else "missing"
    raise BadData(f"{path}: metadata {key} is {found}; export the weights again")


def _form(path, metadata):
    if metadata.get("form") not in FORMS:
        found = metadata.get("form", "")
        raise BadData(f"{path}: metadata form is '{found}', not one of {', '.join(FORMS)}; train again")
    return metadata["form"]


def _read_scaling(path, metadata):
    if metadata["inputs"].split(",") != list(ORDER):
        raise BadData(f"{path}: metadata inputs: this trainer feeds {','.join(ORDER)}; train again")
    numbers = {k: _numbers(path, metadata, k, count=len(ORDER)) for k in ("input_scales", "envelope")}
    named = {k: dict(zip(ORDER, v)) for k, v in numbers.items()}
    return Scaling(
        named["input_scales"],
        read_number(path, metadata, "length_unit", 1),
        named["envelope"],
        tuple(k for k in metadata.get("without", "").split(",") if k),
    )


def read_weights(path, device="cpu"):
    """(model, scaling or None for the paper's wiring, metadata); a vanilla ConvLSTM where the file says so.
    Throws BadData naming a missing or misshaped tensor."""
    tensors, metadata = load(path)
    kind = metadata.get("sinew.model", "no model")
    if kind not in ("alt_conv_lstm", "conv_lstm"):
        raise BadData(f"{path}: holds {kind}, not alt_conv_lstm weights")
    scaling = _read_scaling(path, metadata) if "inputs" in metadata else None
    options = ModelOptions(
        INPUT_WIDTH if scaling else 9,
        tuple(_numbers(path, metadata, "channels", int)),
        "layers.0.W_s" in tensors,
        read_number(path, metadata, "output_scale", 1),
        read_number(path, metadata, "output_leak", 0),
        read_number(path, metadata, "hidden_leak", 0),
        read_number(path, metadata, "state_clamp", "inf"),
    )
    model = ConvLSTM(options, _form(path, metadata)) if kind == "conv_lstm" else AltConvLSTM(options)
    for name, parameter in model.state_dict().items():
        if name not in tensors or tuple(tensors[name].shape) != tuple(parameter.shape):
            have = tensors[name].shape if name in tensors else "missing"
            raise BadData(
                f"{path}: tensor {name} is {have}, not {tuple(parameter.shape)}; export the weights again"
            )
        if not np.isfinite(tensors[name]).all():
            raise BadData(f"{path}: tensor {name} holds a NaN; export the weights again")
        parameter.copy_(torch.as_tensor(np.array(tensors[name], np.float32)))
    return model.to(device).eval(), scaling, metadata
