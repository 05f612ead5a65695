"""The audit trail and its anchors, read without the product's code: HMAC-SHA256 (RFC 2104) over fields with their lengths, each row with the
hash of the one before it; the key is derived from secret.key as libsodium's manual states for crypto_kdf (BLAKE2b, RFC 7693)."""
import hashlib
import hmac

AUDIT = 1  # number of the trail's key
COLUMNS = "number, at_utc_us, who, role, peer, what, object, detail, hash, changes"


def audit_key(secret_hex):
    return hashlib.blake2b(b"", digest_size=32, key=bytes.fromhex(secret_hex.strip()), salt=AUDIT.to_bytes(8, "little").ljust(16, b"\0"),
                           person=b"tractus1".ljust(16, b"\0")).digest()


def keyed_hash(key, fields):
    parts = (str(field).encode() for field in fields)
    return hmac.new(key, b"".join(b"%d:%s" % (len(part), part) for part in parts), hashlib.sha256).hexdigest()


def hash_of(key, before, row):
    number, at, who, role, peer, what, target, detail, _, changes = row
    return keyed_hash(key, [before, number, at, who, role, peer, what, target, detail] + ([changes] if changes else []))


def broken(data, connection):
    """What does not hold of the trail and of the anchors in the folder: lines, none when all holds."""
    key, hashes, out = audit_key((data / "secret.key").read_text()), {0: "0" * 64}, []
    before = ""
    for row in connection.execute(f"select {COLUMNS} from audit order by number"):
        if row[0] != len(hashes) or row[8] != hash_of(key, before, row):
            out.append(f"row {row[0]}")
        before = hashes[row[0]] = row[8]
    for file, label in (("audit.anchor", "anchor"), ("audit.highwater", "high water")):
        for line in (data / file).read_text().splitlines():
            number, end, count, at, mac = line.split()
            if hashes.get(int(number)) != end or mac != keyed_hash(key, [label, number, end, count, at]):
                out.append(f"{file}: {line[:40]}")
    return out
