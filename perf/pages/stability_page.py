"""Stability on stiff and extreme cases as one self-contained HTML page."""

import math

import stability_plots as plots
from page_html import (MISSING, card, cards, command, device_facts, document, esc, facts, figure, figures, image,
                       masthead, mebibytes, plural, scientific, section, table, times)
from page_input import number, picture, section as part
from stability_data import by_reason

DECADES = 4  # of a bar, up to the bound, which stands at BOUND_AT of its width
BOUND_AT = 80
HEAD = ["case", "bound", "measured", "share of bound, log"]
TIGHTEST = 10
FEW_PICTURES = 12
LONG = 16  # cases of one table
SOFTWARE_ROUNDS = ("its filter and its rounding are its own. The bounds allow for a GPU's: whether it keeps them, a run on "
                   "it tells.")
HALF_STEP = 1 / 510  # of 8 bits: what no display shows


def measured(value):
    value = number(value)
    if value is None:
        return "no number"
    return figures(value) if value == 0 or 0.01 <= abs(value) < 1e4 else scientific(value)


def bar(case):
    """The share of the bound as a bar on a log scale, with its figure; the bound is a tick."""
    if case.share is None:
        return "<b class=fail>not measured</b>" if case.failure else MISSING
    if math.isinf(case.share):
        width, text = 100, "bound is 0"
    elif case.share == 0:
        width, text = 0, "0"
    else:
        width = min(100, max(1, BOUND_AT * (1 + math.log10(case.share) / DECADES)))
        text = (f"{figures(case.share)}×" if case.share >= 10 else
                f"{100 * case.share:.3g} %" if case.share >= 1e-4 else "< 0.01 %")
    css = "bar" if case.passed else "bar over"
    return f'<span class="{css}"><i style="width:{width:.0f}%"></i></span><span class=share>{text}</span>'


def verdict(case):
    return "" if case.passed else "<b class=fail>fails</b> "


def _figures_of(case):
    return [scientific(case.bound) if case.bound and not 0.01 <= case.bound < 1e4 else figures(case.bound),
            MISSING if case.failure else measured(case.raw.get("measured")), bar(case)]


def _measured_what(case, with_family):
    return ": ".join(filter(None, (case.family if with_family else "", case.quantity)))


def _named(case, *lines):
    below = "".join(f"<small>{esc(line)}</small>" for line in lines if line)
    return f"{verdict(case)}{esc(case.name)}{below}"


def tiles(stability, cases):
    made = []
    for case in cases:
        listed = case.raw.get("pictures")
        for entry in listed if isinstance(listed, list) else []:
            path = picture(stability.folder, entry.get("file")) if isinstance(entry, dict) else None
            if path:
                name = str(entry.get("name", ""))
                title = f"<b>{esc(name)}</b>" if name != case.name else ""
                made.append(f'<figure>{image(path.read_bytes(), f"{case.name}: {name}")}'
                            f"<figcaption>{title}{esc(case.name)}</figcaption></figure>")
    return made


def pictures(stability, cases):
    """All pictures of these cases, folded away where they are many."""
    made = tiles(stability, cases)
    if not made:
        return ""
    opened = " open" if len(made) <= FEW_PICTURES else ""
    return (f"<details class=pictures{opened}><summary>{plural(len(made), 'picture')}</summary>"
            f'<div class="tiles">{"".join(made)}</div></details>')


def _folded(cases, shown):
    """Long tables wait behind a line that says how many cases they hold and how near to their bounds."""
    if len(cases) <= LONG:
        return shown
    most = max((case.share for case in cases if case.passed and case.share is not None), default=0)
    failed = sum(1 for case in cases if not case.passed)
    summary = ", ".join(filter(None, (
        f"{len(cases)} cases", f"{failed} fail{'s' if failed == 1 else ''}" if failed else "",
        f"up to {100 * most:.3g} % of the bound" if most else "" if failed else "all measured 0")))
    return f"<details class=long><summary>{summary}</summary>{shown}</details>"


def group(stability, reason, cases, with_family=False):
    """Cases with one reason, which is stated once, or those that have each their own."""
    quantities = {_measured_what(case, with_family) for case in cases}
    one = len(quantities) == 1 and len(cases) > 1
    lines = [[_named(case, "" if one else _measured_what(case, with_family), case.reason if reason is None else "",
                     case.failure), *_figures_of(case)] for case in cases]
    stated = ""
    if one and min(quantities):
        stated += f"<p class=why><b>Measured</b> {esc(min(quantities))}</p>"
    if reason:
        stated += f"<p class=why><b>Bound</b> {esc(reason)}</p>"
    css = ["failed" if not case.passed else "" for case in cases]
    shown = table(HEAD, lines, css="cases", row_css=css)
    shown = shown if with_family else _folded(cases, shown)
    return f"<div class=group>{stated}{shown}{pictures(stability, cases)}</div>"


def family_plots(family):
    parts = []
    for i, (labels, panels) in enumerate(plots.plots_of(family)):
        draw = plots.curves(panels, labels, f"curves-{family.name}-{i}".replace(" ", "-"))
        parts.append(figure(draw, None, f"{esc(labels[1])} over {esc(labels[0])}, on logarithmic scales. "
                            f"What is below {scientific(plots.floor_of(panels), 1)}, or zero, is drawn there."))
    return "".join(parts)


def half_precision(family):
    """From cases named "operations, scene, method": the worst method of each, against what a display shows."""
    worst, scenes = {}, {}
    for case in family.cases:
        operations, _, rest = case.name.partition(", ")
        scene, separator, _ = rest.rpartition(", ")
        if separator and case.measured is not None:
            scenes[scene] = None
            worst.setdefault(operations, {}).setdefault(scene, []).append(case.measured)
    if family.name != "half-precision" or not worst:
        return ""
    lines = []
    for operations, by_scene in worst.items():
        most = max(value for values in by_scene.values() for value in values)
        safe = "safe" if most <= HALF_STEP else "<b class=fail>visible</b>"
        lines.append([esc(operations), *(scientific(max(by_scene[scene])) if scene in by_scene else MISSING
                                         for scene in scenes), f"{255 * most:.2f}", safe])
    return table(["rounded to fp16", *(esc(scene) for scene in scenes), "worst, in steps of 8 bits", "in 8 bits"],
                 lines, css="paper") + (
        '<p class="note">The largest difference from float32 that rounding a group of operations to fp16 makes, of '
        "all methods. Safe: at most half a step of an 8-bit display, so that it cannot be seen.</p>")


def left_out(family):
    """What the plan of each scene did without, by GL's own account, and what that saved."""
    lines, frames = [], set()
    for case in family.cases:
        found = case.extra("left_out")
        if not found:
            continue
        plan, samplers = (found.get(name) if isinstance(found.get(name), list) else [] for name in ("plan", "samplers"))
        ms, all_ms = number(found.get("least_frame_ms")), number(found.get("least_frame_ms_with_all"))
        frames.add(figures(found.get("timed_frames")))
        items = "".join(f"<li>{esc(text)}</li>" for text in plan)
        lines.append([
            _named(case), f"<ul>{items}</ul>" if items else MISSING, figures(found.get("active_uniforms")),
            "<br>".join(f"<code>{esc(name)}</code>" for name in samplers) or "none",
            figures(found.get("fragments")), figures(found.get("layers")),
            mebibytes(found.get("volume_and_skip_bytes")) or MISSING, figures(ms), figures(all_ms),
            times(all_ms / ms if ms and all_ms and found.get("fragments") else None)])
    head = ["scene", "what its plan says", "active uniforms", "samplers", "fragments", "layers",
            "volume and skip structure", f"least of {'/'.join(sorted(frames))}, ms", "with everything, ms", "faster by"]
    return lines and f'<div class="bleed">{table(head, lines, css="scenes")}</div>' or ""


def conditions(family):
    """How much of an input's relative change the picture changes by, and by how much it may."""
    lines = []
    for case in family.cases:
        found = case.extra("condition")
        if not found:
            continue
        limit, jumping = number(found.get("limit")), number(found.get("jumping_share"))
        lines.append([f"{esc(found.get('scene', ''))}<small>{esc(found.get('input', ''))}</small>",
                      scientific(found.get("perturbation"), 2), scientific(found.get("largest_change"), 2),
                      figures(found.get("condition_number")),
                      figures(limit) if limit is not None else "<b>unbounded</b>: a step",
                      f"{100 * jumping:.3g} %" if jumping else "none"])
    head = ["scene, input", "relative change of the input", "largest change of the picture", "condition number",
            "at most, by derivatives", "pixels that jump"]
    return lines and table(head, lines, css="paper") + (
        '<p class="note">The condition number is the largest change of any component of any pixel over the relative '
        "change of the input (of an eye, over its distance from the volume’s centre). A pixel jumps where it changes by "
        "more than derivatives allow: past a step of the transfer function, where change over change has no bound, though "
        "no sample may lie within reach. Shares are of the pixels that the volume covers.</p>") or ""


def family_section(stability, family):
    failed = len(family.failed)
    count = plural(len(family.cases), "case")
    state = f"<b class=fail>{failed} of {count} fail{'s' if failed == 1 else ''}</b>" if failed else (
        f"{count}, all within {'its bound' if len(family.cases) == 1 else 'their bounds'}")
    body = (f"<p class=lede>{state}</p>" + half_precision(family) + left_out(family) + conditions(family)
            + family_plots(family)
            + "".join(group(stability, reason, cases) for reason, cases in by_reason(family.cases)))
    return section(esc(family.title), body, anchor=f"family-{family.name}")


def overview(stability):
    lines = []
    for family in stability.families:
        shares = [case.share for case in family.cases if case.passed and case.share is not None]
        failed = len(family.failed)
        lines.append([f'<a href="#family-{esc(family.name)}">{esc(family.title)}</a>', len(family.cases),
                      len(family.cases) - failed, f"<b class=fail>{failed}</b>" if failed else 0,
                      f"{100 * max(shares):.3g} %" if shares else MISSING])
    cases, failed = len(stability.cases), len(stability.failed)
    lines.append(["all", cases, cases - failed, f"<b class=fail>{failed}</b>" if failed else 0, ""])
    return table(["family", "cases", "pass", "fail", "most of a bound used by a case that passes"], lines, css="paper")


def failures(stability):
    """All that fails, before anything else, with its reasons and its pictures."""
    return "".join(group(stability, reason, cases, with_family=True) for reason, cases in by_reason(stability.failed))


def tightest(stability):
    """The cases that would fail first."""
    passed = sorted((case for case in stability.cases if case.passed and case.share), key=lambda case: -case.share)
    lines = [[_named(case, _measured_what(case, True)), *_figures_of(case)] for case in passed[:TIGHTEST]]
    return table(HEAD, lines, css="cases") if passed else ""


def head(stability):
    cases, failed = len(stability.cases), len(stability.failed)
    device = part(stability.raw, "device")
    seconds = number(stability.raw.get("seconds"))
    found = [card("Cases", cases, f"in {plural(len(stability.families), 'family').replace('familys', 'families')}",
                  "skips"),
             card("Within their bounds", cases - failed, f"{100 * (cases - failed) / cases:.3g} %", "skips"),
             card("Beyond", failed, "listed first" if failed else "none", "" if failed else "skips")]
    line = ", ".join(filter(None, (esc(device.get("renderer", "unknown device")),
                                   f"{figures(seconds)} s" if seconds else "",
                                   "the reduced set" if stability.raw.get("reduced") else "")))
    words = ("<p>Each case states a bound, derived beforehand from formats, rounding and the method, and the reason "
             "for it. It passes where what was measured is not beyond.</p>")
    return masthead("stability", "What stiff and extreme data do to the picture", line, device, words + cards(found),
                    of_software=SOFTWARE_ROUNDS)


def page(stability):
    sections = [
        section("Beyond their bounds", failures(stability)),
        section("Families", overview(stability) + figure(
            plots.shares, stability, "Each dot is a case: what was measured, as a share of its bound. The line is the "
            "bound. Dots on the left rim measured next to nothing, or exactly nothing.")),
        section("Nearest to their bounds", tightest(stability)),
        *(family_section(stability, family) for family in stability.families),
        section("This run", facts([*device_facts(stability.raw), ("Cases", len(stability.cases)),
                                   ("Set", "reduced" if stability.raw.get("reduced") else "full"),
                                   ("Took", f"{figures(stability.raw.get('seconds'))} s"
                                    if number(stability.raw.get("seconds")) else None)])
                + command(stability.raw)),
    ]
    return document("Stability on stiff and extreme cases", head(stability), sections)
