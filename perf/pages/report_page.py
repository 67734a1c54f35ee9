"""The report as one self-contained HTML page."""

import report_plots as plots
from page_html import (MISSING, by, card, cards, command, coverage_words, device_facts, document, esc, facts, figure,
                       figures, image, interval, masthead, mebibytes, millions, on_off, section, table, times)
from page_input import picture, section as part
from report_data import PAPER_FIGURES, number


def head(sweep):
    volume, device = sweep.section("volume"), sweep.section("device")
    line = ", ".join(part for part in (esc(volume.get("name", "volume")), by(volume.get("dims", [])),
                                       esc(device.get("renderer", "unknown device"))) if part)
    return masthead("ratio sweep", "How many planes, how many layers each?", line, device, findings(sweep))


def findings(sweep):
    """What was found, in words and this run's own ratios."""
    found = []
    for series in sweep.series:
        best = series.best
        gain = best.speed_up("slicing")
        against = (f"{times(gain)} ({interval(*best.interval('slicing'))}) the speed of slicing" if gain else
                   "slicing was not measured")
        found.append(card(f"{esc(series.label)}: best at", best.label, f"{figures(best.median_ms)} ms; {against}",
                          "skips" if series.skips else ""))
    return cards(found)


def run_facts(sweep):
    conditions, volume = sweep.section("conditions"), sweep.section("volume")
    size = by(conditions.get("size", []))
    spacing = " × ".join(figures(s) for s in volume.get("spacing_mm", []))
    settings = " · ".join(esc(conditions[key]) for key in ("classify", "space", "target", "lattice")
                          if conditions.get(key))
    termination, shade = conditions.get("termination"), conditions.get("shade")
    layers = conditions.get("total_layers")
    step = number(conditions.get("layer_spacing_mm"))
    views = conditions.get("views")
    return facts([
        *device_facts(sweep.raw),
        ("Volume", " · ".join(part for part in (esc(volume.get("type", "")), f"{spacing} mm" if spacing else "") if part)),
        ("Picture", f"{size}{f', {views} views' if number(views) and views > 1 else ''}" if size else None),
        ("Settings", settings),
        ("Shading, termination", f"{esc(shade or 'off')}, {esc(termination or 'off')}" if size else None),
        ("Layers", f"{layers} in total{f', {figures(step)} mm apart' if step else ''}" if layers else None),
        ("Tight polygons", on_off(conditions.get("tighten"))),
        ("Rounds", f"{conditions.get('rounds')}, in each a frame of every row, in an order shuffled anew"
         if conditions.get("rounds") else None),
    ]) + command(sweep.raw)


def _measured_at(sweep, kind):
    """This run's counterpart of one line of the paper's table: a row per series, where it was measured."""
    def pick(series):
        if kind == "ray casting":
            return next((row for row in series.rows if row.planes == 1), None)
        if kind == "slicing":
            return series.slicing
        between = [row for row in series.rows if row.planes > 1 and row.layers > 1]
        return min(between, key=lambda row: row.median_ms, default=None)
    return [(series, pick(series)) for series in sweep.series]


def paper_table(sweep):
    """The paper's figures as multiples of its own slicing, beside ours as multiples of ours."""
    slicing = PAPER_FIGURES["slicing"]
    rows = []
    for kind, paper in PAPER_FIGURES.items():
        cells = [times(fps / base if fps else None) + (f" <i>({fps:g} fps)</i>" if fps else "")
                 for fps, base in zip(paper, slicing)]
        for series, row in _measured_at(sweep, kind):
            cells.append(f"{times(row.speed_up('slicing'))} <i>({row.label})</i>" if row else MISSING)
        rows.append([kind.capitalize(), *cells])
    head = ["Speed, slicing = 1", "paper’s phone, no skipping", "paper’s phone, skipping",
            *(f"this run, {esc(series.label)}" for series in sweep.series)]
    note = ("The paper’s columns are <strong>another device under other conditions</strong>: Samsung Galaxy S8 "
            "(Exynos 8895, Mali-G71 MP20), stereo at 2960×1440, 2× multisampling, a 256³ skull that fills the "
            "view, about 444 layers a voxel apart, pre-classified colours. Only the multiples of each device’s "
            "own slicing may be read side by side. The best hybrid’s ratio of planes to layers is not given "
            "in its text. Source: B. Tukora, <cite>Pollack Periodica</cite> 15(2), 2020, section 3.")
    return table(head, rows, css="paper") + f'<p class="note">{note}</p>'


def against_plain_slicing(sweep):
    """Best hybrid and best ray casting of all series, as multiples of slicing without skipping and with full polygons."""
    kinds = {"hybrid": [row for row in sweep.rows if row.planes > 1 and row.layers > 1],
             "ray casting": [row for row in sweep.rows if row.planes == 1]}
    return [(f"Best {kind} against plain slicing",
             f"{best.label}: {times(best.speed_up('plain_slicing'))} ({interval(*best.interval('plain_slicing'))})")
            for kind, rows in kinds.items() if rows
            for best in [min(rows, key=lambda row: row.median_ms)] if best.speed_up("plain_slicing")]


def memory_and_speed(sweep):
    memory, build, volume = (sweep.section(n) for n in ("memory", "skip", "volume"))
    block = part(build, "parameters").get("skip_block", "?")
    occupied = number(build.get("occupied_fraction"))
    pairs = [
        ("Peak host memory", mebibytes(memory.get("host_peak_bytes"))),
        ("Volume in memory", mebibytes(volume.get("bytes"))),
        ("Its texture", mebibytes(memory.get("gpu_volume_bytes"))),
        ("Skip structure in memory", mebibytes(build.get("gpu_bytes"))),
        ("Skip structure built in", f"{figures(build['build_ms'])} ms" if number(build.get("build_ms")) is not None else None),
        ("Skip structure", f"{esc(build['structure'])}, blocks of {esc(block)}³ voxels"
         if build.get("structure") else None),
        ("Blocks not free", f"{100 * occupied:.1f} %" if occupied is not None else None),
    ]
    for series in sweep.series:
        best = series.best
        if best.speed_up("slicing"):
            pairs.append((f"Best, {series.label}", f"{best.label}: {times(best.speed_up('slicing'))} slicing "
                          f"({interval(*best.interval('slicing'))}), {figures(best.fps)} fps"))
    return facts(pairs + against_plain_slicing(sweep))


def _ratio(row, over):
    value = row.speed_up(over)
    return f"{times(value)}<br><i>{interval(*row.interval(over))}</i>" if value else MISSING


def paired_words(sweep):
    """What a ratio is, and its interval."""
    return ("A ratio is the median over the rounds of one row’s time over the other’s of the same round, so that a "
            "drifting machine hits both. " + coverage_words(next((row.coverage for row in sweep.rows), None)))


def model_table(sweep):
    """What a model finds best on each GPU, and what holds it back there."""
    series, gpus = sweep.modelled
    rows = []
    for gpu in gpus:
        best = min((row for row in series.rows if row.model(gpu)), key=lambda row: row.model(gpu)["frame_ms"])
        said = best.model(gpu)
        low, high = (number(said.get(end)) or said["frame_ms"] for end in ("low_ms", "high_ms"))
        rows.append([esc(said.get("device", gpu)), best.label, f"{figures(said['frame_ms'])} ms",
                     f"{figures(low)} – {figures(high)} ms", esc(said.get("limit", "")),
                     f"{figures(number(said.get('divergence_ms')) or 0)} ms"])
    note = ("<strong>A model, not a measurement</strong>: work that was counted in this run, times what each GPU\u2019s own "
            "compiler says of the shader that it would be given, over what is published of the GPU; nothing is fitted. "
            "The range is of what sources differ in, and of an instruction cache whose size is not published. It knows "
            "no cache misses, no other apps and no heat. perf/README.md says what it was held against.")
    return table(["Model of", "best ratio", "frame", "range", "held back by", "of it divergence"], rows) + \
        f'<p class="note">{note}</p>'


def model_section(sweep):
    """Nothing where no compiler's figures are there for these shaders."""
    if not sweep.modelled[1]:
        return []
    return [section("Other GPUs, by a model", figure(
        plots.model_times, sweep, "Model: frame times of phones and headsets that were not at hand, for "
        f"{esc(sweep.modelled[0].label)}; in grey what was measured here, which no model is fitted to.") + model_table(sweep))]


def all_rows(sweep):
    head = ["planes × layers", "skipping", "form", "tight", "median ms", "min – max", "p10 – p90", "n", "fps",
            "× slicing", "× the same drawn plainly", "fragments", "layers", "skipped", "volume fetches", "skip fetches", "compile ms", "first frame ms", "variant"]
    lines = []
    for series in sweep.series:
        for row in series.rows:
            ms, raw = row.raw["frame_ms"], row.raw
            lines.append([
                row.label, esc(raw.get("skip", MISSING)), esc(raw.get("form", MISSING)),
                on_off(raw.get("tighten")) or MISSING, f"<b>{figures(row.median_ms)}</b>",
                f"{figures(row.low_ms)} – {figures(row.high_ms)}",
                f"{figures(ms.get('p10'))} – {figures(ms.get('p90'))}", figures(ms.get("n")), figures(row.fps),
                *(_ratio(row, over) for over in ("slicing", "plain")),
                *(millions(row.counter(name)) for name in plots.COUNTERS),
                figures(raw.get("compile_ms")), figures(raw.get("first_frame_ms")), f"<code>{esc(raw.get('variant', MISSING))}</code>"])
    return table(head, lines, css="rows") + f'<p class="note">Counters are millions per frame. {paired_words(sweep)} Percentiles need 9 rounds.</p>'


def _pictures(sweep, ratio):
    """Bytes of each different picture of one ratio -> (labels of the series, files) that hold it."""
    pictures = {}
    for series in sweep.series:
        for row in series.rows:
            path = picture(sweep.folder, row.raw.get("thumbnail")) if row.ratio == ratio else None
            if path:
                labels, paths = pictures.setdefault(path.read_bytes(), ([], set()))
                labels.append(series.label)
                paths.add(path)
    return pictures


def _thumbnail_note(pictures_by_ratio):
    """Claims sameness only where every ratio has a file of each of several series."""
    if any(len(pictures) > 1 for pictures in pictures_by_ratio.values()):
        return "<p>Where the series’ pictures differ, in however small a way, each is shown.</p>"
    if all(len(paths) > 1 for pictures in pictures_by_ratio.values() for _, paths in pictures.values()):
        return ("<p>At every ratio the pictures of all series, with and without skipping, are the same file, "
                "byte for byte, so each is shown once.</p>")
    return ""


def thumbnails(sweep):
    """One picture per ratio where all series agree byte for byte; else each series' own."""
    found = {ratio: pictures for ratio in sweep.ratios if (pictures := _pictures(sweep, ratio))}
    tiles = []
    for (planes, layers), pictures in found.items():
        for data, (labels, _) in pictures.items():
            which = f"<i>{esc('; '.join(labels))}</i>" if len(pictures) > 1 else ""
            tiles.append(f'<figure>{image(data, f"The volume at {planes}×{layers}")}'
                         f"<figcaption>{planes}×{layers}{which}</figcaption></figure>")
    return f'{_thumbnail_note(found)}<div class="tiles">{"".join(tiles)}</div>' if tiles else ""


def page(sweep):
    loops = any(row.raw.get("form") == "loop" for row in sweep.rows)
    sections = [
        section("This run", run_facts(sweep)),
        section("Frame time over the ratio", figure(
            plots.frame_times, sweep, "The core paper’s Fig. 4 for this device: median frame time, with whiskers from the "
            "fastest to the slowest frame." + (" Hollow points use the loop form of the shader." if loops else ""))),
        section("Beside the paper", figure(
            plots.speed_ups, sweep, "Speed in multiples of this device’s own slicing, of the same series. " + paired_words(sweep))
            + paper_table(sweep)),
        section("Work per frame", figure(
            plots.counters, sweep, "What the shader did. Counts, not times: they depend on the picture, not on the device’s speed.")),
        *model_section(sweep),
        section("Memory and speed", memory_and_speed(sweep)),
        section("Compiling the variants", figure(
            plots.compile_times, sweep, "Compile and link of each variant’s program, by the host’s clock until the driver says that it is "
            "linked; and what its first frame took beyond a usual one, where drivers put work off until then. Mesa’s cache of shaders is off.")),
        section("Pictures", thumbnails(sweep)),
        section("Every row", all_rows(sweep)),
    ]
    title = f"Ratio sweep: {esc(sweep.section('volume').get('name', 'volume'))}"
    return document(title, head(sweep), sections)
