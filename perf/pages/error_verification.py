"""The page's sections on whether the errors are what theory says, and on what they are made of."""

import json

import error_verification_plots as plots
from error_plots import rank_by_time
from page_html import MISSING, esc, facts, figure, figures, scientific, section, table
from page_input import number, picture, section as part


def _order(value):
    value = number(value)
    return MISSING if value is None else f"{round(value, 2) + 0.0:.2f}".replace("-", "−")


def _voxels(value):
    text = figures(value)
    return f"{text} voxel{'' if text == '1' else 's'}"


def _verdict(entry):
    """Right, or what is wrong; of a control, whether it was found out."""
    if entry.get("control"):
        text = "passes as right" if entry.get("looks_right") else "found out"
        bad = bool(entry.get("looks_right")) or not entry.get("as_expected")
        text += "" if entry.get("as_expected") else ", of another order than its mistake’s"
    else:
        bad = not entry.get("as_expected")
        text = "not as expected" if bad else "as expected"
    return f'<span class="fail">{text}</span>' if bad else text


def _asymptotic(entry):
    return f"{'yes' if entry.get('asymptotic') else 'no'}<br><i>{esc(entry.get('why', ''))}</i>"


def _levels(entry):
    levels = [level for level in entry.get("levels") or [] if isinstance(level, dict)]
    return " → ".join(scientific(level.get("rmse"), 2) for level in levels)


def refinement(errors):
    found = sorted(plots.studies(errors), key=lambda s: (list(plots.KINDS).index(s["kind"])
                                                         if s.get("kind") in plots.KINDS else 9, bool(s.get("control"))))
    if not found:
        return ""
    drawn = figure(plots.refinement, errors, "Against pictures that are known exactly, in a field by formula. Each "
                   "line refines one thing and leaves the others so fine that they do not show. Solid: what should be "
                   "right. Dashed: deliberate mistakes, which must show another slope. Grey: the slopes expected.")
    lines = [[f"{esc(s.get('kind'))}: {esc(s.get('method'))}", _levels(s), _order(s.get("order")),
              _order(s.get("self_order")), _order(s.get("expected_order")), _asymptotic(s), _verdict(s)] for s in found]
    css = ["failed" if "fail" in line[-1] else "" for line in lines]
    head = ["what is refined, and how", "RMSE, coarse to fine", "order", "by changes", "expected", "asymptotic",
            "verdict"]
    why = "".join(f"<dt>{esc(s.get('kind'))}: {esc(s.get('method'))}</dt><dd>{esc(s.get('why_expected', ''))}</dd>"
                  for s in found)
    note = ("Order: how fast the error falls from the last level but one to the last that is above the floor. By "
            "changes: the same of the differences from level to level, which know of no truth: what has an order by its "
            "changes and none against the truth converges to something else. Asymptotic: the last three orders agree.")
    return (drawn + table(head, lines, css="budgets", row_css=css)
            + f'<p class="note">{note}</p><details><summary>Why these orders</summary>'
            f'<dl class="why">{why}</dl></details>')


def families(errors):
    """Whether this volume's own sampling error falls as its classification promises."""
    found = [entry for entry in errors.raw.get("convergence") or [] if isinstance(entry, dict)]
    lines = [[esc(plots.family_name(entry)), _levels(entry), _order(entry.get("order")),
              f"{_order(entry.get('expected_order'))}<br><i>{esc(entry.get('why_expected', ''))}</i>",
              _asymptotic(entry), _verdict(entry) if entry.get("asymptotic") else "cannot be told"] for entry in found]
    head = ["this volume’s sampling", "RMSE, coarse to fine", "order", "expected", "asymptotic", "verdict"]
    note = ("One lattice alone: how faces of the volume and corners of the transfer function cut its layers is chance, "
            "and what is not asymptotic at these spacings may be at finer ones.")
    return table(head, lines, css="budgets") + f'<p class="note">{note}</p>' if lines else ""


def predicted_step(errors):
    found = part(errors.raw, "predicted_step")
    if not found:
        return ""
    ratio = number(found.get("ratio"))
    both = facts([
        ("Predicted, steepest visible gradient", f"{_voxels(found.get('predicted_voxels'))} "
                                                 f"({figures(found.get('predicted_mm'))} mm)"),
        ("Predicted, 99 % of the visible cells", _voxels(found.get("predicted_p99_voxels"))),
        ("Measured", f"{_voxels(found.get('measured_voxels'))}, RMSE {scientific(found.get('measured_rmse'))}"),
        ("Measured over predicted", f"{figures(ratio)} (of 99 %: {figures(found.get('ratio_p99'))})"),
        ("Transfer function, highest frequency", f"{figures(found.get('transfer_cycles_per_unit'))} cycles a unit "
                                                 f"({figures(100 * (number(found.get('energy_share')) or 0))} % of "
                                                 "its energy)"),
        ("Gradient, steepest visible", f"{figures(found.get('gradient_per_mm'))} a mm"),
        ("Threshold", f"RMSE {scientific(found.get('threshold_rmse'))}"),
    ])
    note = ("Nyquist’s step for a transfer function of that frequency along that gradient (Bergner et al. 2006), beside "
            "the coarsest spacing from which on sampling alone stays below the threshold.")
    return f'<p>{note}</p>{both}<p class="why"><b>Why they are apart.</b> {esc(found.get("why", ""))}.</p>'


def _signed(value):
    value = number(value)
    return MISSING if value is None else ("+" if value > 0 else "") + scientific(value, 2)


def _percent(value):
    value = number(value)
    return MISSING if value is None else f"{100 * value:.3g} %"


def parts_of_error(errors):
    """Bias and scatter, what shows in eight bits, alpha on its own and FLIP, of the front's rows."""
    lines = []
    for row in errors.front:
        total, seen = part(part(row.raw, "error"), "total"), part(row.raw, "flip")
        if number(total.get("bias")) is None:
            continue
        lines.append([
            f"{rank_by_time(row.rank)} · {esc(errors.name(row))}", scientific(row.rmse, 2), _signed(total.get("bias")),
            scientific(total.get("deviation"), 2),
            " ".join(_signed(total.get(f"{name}_bias")) for name in ("red", "green", "blue")),
            _percent(total.get("visible_share")), scientific(total.get("alpha_rmse"), 2),
            _signed(total.get("alpha_bias")), _percent(total.get("alpha_visible_share")),
            figures(seen.get("mean")), figures(seen.get("max")), figures(total.get("mean_delta_e"))])
    if not lines:
        return ""
    density = next((value for row in errors.front
                    if (value := number(part(row.raw, "flip").get("pixels_per_degree")))), None)
    head = ["front", "RMSE", "bias", "deviation", "bias of R, G, B", "off by > 1/255", "alpha RMSE", "alpha bias",
            "alpha off by > 1/255", "FLIP, mean", "FLIP, max", "mean ΔE"]
    note = ("Bias is the mean of picture − reference, deviation what scatters around it: RMSE² = bias² + deviation². "
            "Off by more than 1/255: share of the pixels, in any of R, G, B. FLIP (Andersson et al. 2020) at "
            f"{figures(density)} pixels a degree: 0 for no difference that flipping between the two shows, 1 for the "
            "greatest.")
    return f'<div class="bleed">{table(head, lines, css="rows")}</div><p class="note">{note}</p>'


def _ray(errors):
    """The traced ray's own file; nothing where it is missing or something else."""
    path = picture(errors.folder, part(errors.raw, "worst_ray").get("json", ""))
    try:
        ray = json.loads(path.read_text(encoding="utf-8")) if path else {}
    except (OSError, ValueError):
        return {}
    return ray if isinstance(ray, dict) else {}


def _place(values):
    return ", ".join(figures(v) for v in values) if isinstance(values, list) else MISSING


def worst_ray(errors):
    ray = _ray(errors)
    drawn = figure(plots.worst_ray, ray, "Top: the field along the ray and the transfer function’s opacity. Middle: "
                   "what the layers gathered in float64, dashed, over the exact integral. Bottom: their difference.") \
        if ray else ""
    if not drawn:
        return ""
    where = facts([
        ("Row", f"<code>{esc(ray.get('row'))}</code>"),
        ("Pixel", f"{_place(ray.get('pixel_from_the_top'))} from the upper left"),
        ("Off by", scientific(ray.get("error"))),
        ("Drawn", _place(ray.get("picture"))), ("Layers in float64", _place(ray.get("gathered"))),
        ("Exact", _place(ray.get("exact"))),
        ("Eye, mm", _place(ray.get("eye_mm"))), ("Enters at, mm", _place(ray.get("entry_place_mm"))),
        ("Leaves at, mm", _place(ray.get("exit_place_mm"))), ("Layers met", esc(ray.get("layers_met"))),
    ])
    note = (f"<p>The pixel that is farthest from the reference, of the row that is named: layer by layer in "
            f"<code>{esc(ray.get('json'))}</code> and <code>{esc(ray.get('csv'))}</code>. Drawn minus layers is what "
            "the device adds; layers minus exact is what sampling costs.</p>")
    return note + drawn + where


def sections(errors):
    """All of them; what was not measured is left out."""
    return [
        section("Do the errors fall as they must?", refinement(errors) + families(errors), "refinement"),
        section("The step that was predicted", predicted_step(errors), "predicted-step"),
        section("What the front’s errors are made of", parts_of_error(errors), "parts"),
        section("The worst ray", worst_ray(errors), "worst-ray"),
    ]
