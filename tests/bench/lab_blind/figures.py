"""Numbers of a test: intervals of rates, percentiles, reliability of stated probabilities. Standard library alone."""
import math


def wilson(hits, count, z=1.959964):
    """95 % interval of a rate (Wilson 1927): (rate, low, high); None where nothing was counted."""
    if count == 0:
        return None
    p = hits / count
    middle = p + z * z / (2 * count)
    spread = z * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    scale = 1 + z * z / count
    return p, max(0.0, (middle - spread) / scale), min(1.0, (middle + spread) / scale)


def percentile(values, share):
    """Linear between order statistics; None of an empty list."""
    if not values:
        return None
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low = math.floor(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])


def reliability(claims, edges=(0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0000001)):
    """claims: (stated probability, came true). Returns (bins, expected calibration error)."""
    bins = []
    error = 0.0
    for low, high in zip(edges, edges[1:]):
        inside = [(p, right) for p, right in claims if low <= p < high]
        if not inside:
            continue
        stated = sum(p for p, _ in inside) / len(inside)
        hits = sum(bool(right) for _, right in inside)
        bins.append({"from": low, "to": min(high, 1.0), "count": len(inside), "stated": stated,
                     "true": hits / len(inside), "interval": wilson(hits, len(inside))[1:]})
        error += len(inside) / len(claims) * abs(stated - hits / len(inside))
    return bins, (error if claims else None)
