"""Error against run time as one self-contained HTML page."""

import error_plots as plots
import error_verification as verification
from error_data import NAMES, PARTS, say
from page_html import (MISSING, by, card, cards, command, device_facts, document, esc, facts, figure, figures, image,
                       masthead, mebibytes, millions, on_off, plural, scientific, section, table)
from page_input import number, picture, section as part

SEEN = 1.0  # of Delta E 2000: about what an eye can just tell apart
MOST_BUDGETS = 5


def row_name(errors, row, without=()):
    return esc(errors.name(row, without))


def _budgets(errors):
    """Round times, 1-2-5, that the slowest row needs or the fastest has; thinned to a few."""
    times = [row.median_ms for row in errors.rows]
    steps = [m * 10.0 ** e for e in range(-4, 8) for m in (1, 2, 5)]
    first = next((i for i, step in enumerate(steps) if step >= min(times)), 0)
    last = next((i for i, step in enumerate(steps) if step >= max(times)), len(steps) - 1)
    stride = -(-(last - first + 1) // MOST_BUDGETS)
    return sorted(steps[last:first - 1 if first else None:-stride])


def budget_table(errors):
    """The most accurate row of each classification within each budget; the best of a line in bold."""
    lines = []
    for budget in _budgets(errors):
        found = [errors.best_within(budget, name) for name in errors.classifications]
        least = min(row.rmse for row in found if row) if any(found) else None
        cells = []
        for row in found:
            value = scientific(row.rmse) if row else MISSING
            cells.append(MISSING if row is None else
                         (f"<b>{value}</b>" if row.rmse == least else value)
                         + f"<br><i>{row_name(errors, row, ('classification',))}</i>")
        lines.append([f"{figures(budget)} ms", *cells])
    head = ["time a frame, at most", *(f"{esc(NAMES.get(name, name))}" for name in errors.classifications)]
    return table(head, lines, css="budgets") + ('<p class="note">Least RMSE among the rows that are no slower, by '
                                                'median; in bold the best of a line.</p>')


def _who_leads(errors):
    """How large the front is, and which classification is the most accurate within which budget."""
    winners = []
    for budget in _budgets(errors):
        found = [row for name in errors.classifications if (row := errors.best_within(budget, name))]
        best = min(found, key=lambda row: row.rmse, default=None)
        if best and winners and winners[-1][1].classification == best.classification:
            winners[-1] = (winners[-1][0], best, budget)
        elif best:
            winners.append((budget, best, budget))
    told = []
    for first, best, last in winners:
        span = f"{figures(first)} ms" if first == last else f"{figures(first)} to {figures(last)} ms"
        told.append(f"within {span}, {esc(NAMES.get(best.classification, best.classification))} "
                    f"(RMSE {scientific(best.rmse)})")
    front = len(errors.front)
    return (f"Of {plural(len(errors.rows), 'setting')} measured, {front} {'is' if front == 1 else 'are'} on the "
            "front, where nothing is both faster and more accurate."
            + (f" Most accurate are: {'; '.join(told)}." if told else ""))


def _where_eight_bits_break(errors):
    """From how many planes on RGBA8's error is more than twice RGBA16F's, per classification."""
    told = []
    for name, targets in plots.target_groups(errors):
        pairs = list(zip(targets["rgba8"], targets["rgba16f"]))
        breaks = None
        for eight, half in reversed(pairs):  # from there on, and not once by chance
            if not eight.rmse > 2 * half.rmse:
                break
            breaks = eight, half
        said = esc(NAMES.get(name, name))
        if breaks:
            eight, half = breaks
            told.append(f"{said} from {plural(eight.planes, 'plane')} on ({scientific(eight.rmse)} against "
                        f"{scientific(half.rmse)})")
        else:
            told.append(f"{said} at none of {pairs[0][0].planes} to {pairs[-1][0].planes} planes")
    return f"RGBA8 more than doubles RGBA16F’s error: {'; '.join(told)}." if told else ""


def headline(errors):
    text = " ".join(filter(None, (_who_leads(errors), _where_eight_bits_break(errors))))
    return f'<p class="headline">{text}</p>' if text else ""


def front_cards(errors):
    """The front's two ends, and the cheapest picture that an eye can hardly tell from the truth."""
    def made(title, row):
        return card(title, f"{figures(row.median_ms)} ms", f"RMSE {scientific(row.rmse)}; {row_name(errors, row)}",
                    "skips")
    alike = min((row for row in errors.rows if (delta := row.error("total", "p999_delta_e")) is not None
                 and delta <= SEEN), key=lambda row: row.median_ms, default=None)
    found = [made("Fastest", errors.front[0])] if errors.front else []
    if alike:
        found.append(made("Fastest with ΔE ≤ 1 in 99.9 % of pixels", alike))
    if len(errors.front) > 1:
        found.append(made("Most accurate", errors.front[-1]))
    return cards(found)


def head(errors):
    volume, device = errors.section("volume"), errors.section("device")
    line = ", ".join(text for text in (esc(volume.get("name", "volume")), by(volume.get("dims")),
                                       esc(device.get("renderer", "unknown device"))) if text)
    return masthead("error against run time", "How far from the truth, and at what price?", line, device,
                    headline(errors) + front_cards(errors))


def run_facts(errors):
    conditions, volume, reference = (errors.section(name) for name in ("conditions", "volume", "reference"))
    spacing = " × ".join(figures(s) for s in volume.get("spacing_mm") or [])
    camera = conditions.get("camera")
    tolerance, seconds = number(reference.get("tolerance")), number(reference.get("seconds"))
    frames = conditions.get("frames_per_row_at_most")
    earlier = len(errors.measured_earlier)
    resumed = (f'<p class="note">{plural(earlier, "row")} {"was" if earlier == 1 else "were"} measured earlier, in a '
               "run that was cut short.</p>") if earlier else ""
    settings = " · ".join(esc(conditions[name]) for name in ("space", "lattice") if conditions.get(name))
    entries = [entry for entry in errors.raw.get("left_out") or [] if isinstance(entry, dict)]
    left_out = "".join(
        f'<p class="note">Left out: {esc(NAMES.get(entry.get("classify"), entry.get("classify")))}: '
        f'{esc(entry.get("why", ""))}</p>' for entry in entries)
    return facts([
        *device_facts(errors.raw),
        ("Volume", " · ".join(filter(None, (esc(volume.get("type", "")), esc(volume.get("unit", "")),
                                            f"{spacing} mm" if spacing else "", mebibytes(volume.get("bytes")))))),
        ("Picture", by(conditions.get("size"))),
        ("Camera", f"{', '.join(figures(v) for v in camera)}; {figures(conditions.get('fov_degrees'))}° high"
         if isinstance(camera, list) else None),
        ("Transfer function", esc(conditions.get("transfer_function", ""))),
        ("Space, lattice", settings),
        ("Texels", esc(conditions.get("texel_format", ""))),
        ("Skipping, form", " · ".join(esc(conditions[name]) for name in ("skip", "form") if conditions.get(name))),
        ("Tight polygons", on_off(conditions.get("tighten"))),
        ("Reference", f"float64, to {scientific(tolerance, 1)} relative; {figures(seconds)} s" if tolerance else None),
        ("Frames per row", f"at most {esc(frames)}{' (quick run)' if conditions.get('quick') else ''}" if frames else None),
        ("Rows", len(errors.rows)),
    ]) + command(errors.raw) + resumed + left_out


def _front_list(errors, front, letter):
    """The marks of a plot that has no room for names."""
    items = "".join(f"<div><dt>{letter(rank)}</dt><dd>{row_name(errors, row)}</dd></div>"
                    for rank, row in enumerate(front, 1))
    crowded = len(front) > plots.MOST_NAMES
    return f'<dl class="marks{"" if crowded else " narrow"}">{items}</dl>' if front else ""


def work_precision(errors):
    by_time = figure(plots.by_time, errors, "Root mean square error of red, green and blue over black against the "
                     "float64 reference of the continuous model, over the median frame time. Whiskers reach from "
                     "the fastest to the slowest frame. The staircase is the Pareto front.")
    by_fetches = figure(plots.by_fetches, errors, "The same over the texture fetches of a frame, which depend on the "
                        "picture and not on the device’s speed.")
    first = section("Error over frame time", by_time and by_time
                    + _front_list(errors, errors.front, plots.rank_by_time) + budget_table(errors))
    second = section("Error over fetches", by_fetches and by_fetches
                     + _front_list(errors, errors.front_by_fetches, plots.rank_by_fetches))
    return first + "\n" + second


def _setting_of(rows):
    return esc(", ".join(say(rows[0], name) for name in ("layer_spacing", "termination")))


def planes_caption(errors):
    shown = "; ".join(f"{esc(NAMES.get(name, name))}: {_setting_of(targets['rgba8'])}"
                      for name, targets in plots.target_groups(errors))
    return ("The same samples, dealt out to ever more planes, each blended into the target. Every blend rounds: to a "
            f"255th in RGBA8, to 11 bits in RGBA16F. Shown are {shown}; no jitter.")


def _jitter_words(errors):
    pairs = errors.pairs("jitter", False, True)
    better = sum(1 for off, on in pairs if on.rmse < off.rmse)
    return (f"Each point is one setting, with jitter over without. Below the diagonal jitter helps: in {better} of "
            f"{plural(len(pairs), 'pair')} the RMSE is smaller with it.")


def pictures(errors):
    """The reference, then each of the front's pictures beside its difference from it."""
    def shown(relative, alt):
        path = picture(errors.folder, relative)
        return image(path.read_bytes(), alt) if path else ""
    reference = shown(errors.section("reference").get("picture"), "The reference picture")
    tiles = [f'<figure><div class="pair">{reference}</div><figcaption><b>The reference</b>'
             "float64, continuous model</figcaption></figure>"] if reference else []
    for row in errors.front:
        files = part(row.raw, "pictures")
        both = (shown(files.get("thumbnail"), f"Picture of {row.id}")
                + shown(files.get("difference"), f"Difference of {row.id}"))
        factor = number(files.get("difference_factor"))
        times = f", difference × {figures(factor)}" if factor else ""
        if both:
            tiles.append(f'<figure><div class="pair">{both}</div><figcaption><b>{row.rank}</b>'
                         f"{row_name(errors, row)}<br>RMSE {scientific(row.rmse)}, {figures(row.median_ms)} ms{times}"
                         "</figcaption></figure>")
    note = ("<p>What the front’s settings draw, fastest first; on the right of each the absolute difference from the "
            "reference, amplified by the factor that is stated.</p>")
    return f'{note}<div class="tiles pairs">{"".join(tiles)}</div>' if tiles else ""


def _order(row):
    return ", ".join(figures(value, 2) if (value := row.order_of(name)) is not None else MISSING
                      for name in ("total", "sampling"))


def all_rows(errors):
    head = ["setting", "front", "RMSE", "PSNR, dB", "max", "mean ΔE", "p99.9 ΔE", "sampling", "table", "GPU",
            "order: total, sampling", "ms, median", "min – max", "frames", "fetches, M", "planes × layers", "classification",
            "target", "termination", "jitter", "command"]
    lines = []
    for row in errors.sorted_rows:
        plan, fronts = part(row.raw, "plan"), []
        if row.rank:
            fronts.append(plots.rank_by_time(row.rank))
        if row.rank_by_fetches:
            fronts.append(plots.rank_by_fetches(row.rank_by_fetches))
        lines.append([
            f"<code>{esc(row.id)}</code>", " · ".join(fronts) or MISSING, f"<b>{scientific(row.rmse)}</b>",
            figures(row.error("total", "psnr")), scientific(row.error("total", "max")),
            figures(row.error("total", "mean_delta_e")), figures(row.error("total", "p999_delta_e")),
            *(scientific(row.error(name)) for name in PARTS[1:]), _order(row), f"<b>{figures(row.median_ms)}</b>",
            f"{figures(row.low_ms)} – {figures(row.high_ms)}", esc(row.frames or MISSING), millions(row.fetches),
            f"{row.planes}×{esc(plan.get('layers_per_plane', '?'))}",
            esc(NAMES.get(row.classification, row.classification)),
            esc(NAMES.get(row.target, row.target)), esc(say(row, "termination")), on_off(row.jitter),
            f"<details><summary>show</summary><code>{esc(row.raw['command'])}</code></details>"
            if row.raw.get("command") else MISSING])
    css = ["front" if row.rank else "" for row in errors.sorted_rows]
    note = ("The front’s rows first, then the others, each the most accurate first. Sampling, table and GPU are the "
            "RMSE of the error’s three parts: what finite layers and classifying first cost, what the transfer "
            "function’s table costs, and what texel format, filter, float32, termination and blending into the target "
            "cost. Order: how fast the error falls from "
            "the next coarser spacing to this one. ΔE is CIE Delta E 2000.")
    return f'<p class="note">{note}</p><div class="bleed">{table(head, lines, css="rows", row_css=css)}</div>'


def page(errors):
    sections = [
        work_precision(errors),
        section("Convergence", figure(
            plots.convergence, errors,
            "The error and its three parts over layers per voxel, for one family of settings of each classification. "
            "Grey lines fall as an error of order 1 and of order 2 would. Parts that are exactly zero or were not "
            "measured are not drawn.")),
        *verification.sections(errors),
        section("Where RGBA8 blending breaks", figure(plots.by_planes, errors, planes_caption(errors))),
        section("What jitter costs and gains", figure(plots.jitter, errors, _jitter_words(errors))),
        section("Pictures of the front", pictures(errors)),
        section("This run", run_facts(errors)),
        section("Every row", all_rows(errors)),
    ]
    return document(f"Error against run time: {esc(errors.section('volume').get('name', 'volume'))}", head(errors),
                    sections)
