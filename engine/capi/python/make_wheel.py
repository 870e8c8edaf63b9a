#!/usr/bin/env python3
"""Makes a wheel of the package with its library, without any tool: python3 make_wheel.py LIBRARY FOLDER."""

import base64
import hashlib
import platform
import re
import sys
import zipfile
from pathlib import Path


def main(library: str, folder: str) -> None:
    here = Path(__file__).parent
    real = Path(library).resolve()
    found = re.search(r"\.so\.(\d+\.\d+\.\d+)$", real.name)
    if not found:
        sys.exit(f"make_wheel: expected libpalpate.so.0 with its version, found {real.name}")
    version, tag = found[1], f"py3-none-linux_{platform.machine()}"
    about = f"palpate-{version}.dist-info"
    files = {"palpate/__init__.py": (here / "palpate" / "__init__.py").read_bytes(),
             "palpate/py.typed": b"",  # type checkers read hints of packages that have it
             "palpate/libpalpate.so.0": real.read_bytes(),
             f"{about}/METADATA": (f"Metadata-Version: 2.1\nName: palpate\nVersion: {version}\n"
                                   "Summary: Touch of thin, soft objects of varying stiffness\n"
                                   "Requires-Python: >=3.8\nRequires-Dist: numpy\n").encode(),
             f"{about}/WHEEL": f"Wheel-Version: 1.0\nGenerator: palpate\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()}
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{about}/RECORD"] = (record + f"{about}/RECORD,,\n").encode()
    path = Path(folder) / f"palpate-{version}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            wheel.writestr(zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0)), content, zipfile.ZIP_DEFLATED)
    print(path)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
