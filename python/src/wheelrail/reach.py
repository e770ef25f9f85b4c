"""Files over positions against the track of a run: what lies wholly ahead of it or behind it, and gaps in samples."""

from statistics import median

from .warn import warn

GAP = 10.0  # usual distances of samples from which on a distance is a gap
SHORT, NEAR = 0.01, 10.0  # share of a track, and mean length of sections [m], below which it is doubtful that these are in metres
CHAINAGE = 10.0  # times as large are both for a track that has chainages, which are often written in km
FEW = 10  # samples that have no usual distance


def check_reach(track, path):
    """Warns of sections and profiles that have no effect on a track from `begin` on."""
    begin, end = track.begin, track.begin + track.length
    place, condition = track.sections.position, track.sections.condition
    way = f"the track, which goes from begin = {begin:g} m to {end:g} m (length = {track.length:g} m)"
    chainage = f"if positions are chainages, set begin in {path} to that of the start"
    if place[0] > begin:
        where = "all sections lie ahead of" if place[0] >= end else "the sections begin ahead of the beginning of"
        warn(f"{track.path}: {where} {way}: the first one, {condition[0]!r} from {place[0]:g} m on, reaches back; {chainage}")
    if len(place) > 1 and place[-1] <= begin and place[-1] != 0.0:
        warn(
            f"{track.path}: all sections, from {place[0]:g} to {place[-1]:g} m, begin behind {way}: only the last one, "
            f"{condition[-1]!r}, has an effect; {chainage}"
        )
    wide = CHAINAGE if begin else 1.0
    if len(place) > 1 and begin < place[-1] < begin + wide * SHORT * track.length and place[-1] - place[0] < wide * NEAR * (len(place) - 1):
        warn(
            f"{track.path}: the last section, {condition[-1]!r} from {place[-1]:g} m on, has nearly all of {way}; if positions are in km, call "
            f"the column position [km]{f', and write begin in m: {1e3 * begin:g}' if begin else ''}"
        )
    if track.profile and not (track.profile.position[0] < end and track.profile.position[-1] > begin):
        first, last = track.profile.position[0], track.profile.position[-1]
        where = "ahead of" if first >= end else "behind"
        warn(f"{path}: profile has no effect: its positions, {first:g} to {last:g} m, lie {where} {way}; {chainage}")


def check_gap(path, positions, heights):
    """Warns of the longest distance between two samples of different height, if it is far longer than usual."""
    pairs = list(zip(positions, positions[1:], heights, heights[1:]))
    uneven = [(after - before, before, after) for before, after, low, high in pairs if low != high]
    if len(pairs) < FEW or not uneven:
        return
    usual, (length, before, after) = median(after - before for before, after, *_ in pairs), max(uneven)
    if length > GAP * usual:
        warn(
            f"{path}: no samples between {before:g} and {after:g} m, where they usually are {usual:g} m apart: the rail is straight "
            "there; fill the gap, or confirm it by samples"
        )
