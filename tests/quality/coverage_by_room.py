"""Reads the summary that llvm-cov exports, prints the share of lines that were reached: a line a room, the files that were reached least, and all."""
import collections
import json
import sys

root = sys.argv[1].rstrip("/") + "/"
files = {}
for file in json.load(sys.stdin)["data"][0]["files"]:
    name = file["filename"].removeprefix(root)
    if name.startswith(("src/", "apps/")):
        files[name] = (file["summary"]["lines"]["covered"], file["summary"]["lines"]["count"])

rooms = collections.defaultdict(lambda: [0, 0])
for name, (covered, count) in files.items():
    room = "apps" if name.startswith("apps/") else name.split("/")[2]
    for total in (rooms[room], rooms["all"]):
        total[0] += covered
        total[1] += count

def share(covered, count):
    return 100.0 * covered / count if count else 100.0

for room, (covered, count) in sorted(rooms.items(), key=lambda item: (item[0] == "all", item[0])):
    print(f"{room:12s} {covered:6d} of {count:6d} lines  {share(covered, count):5.1f} %")
print("\nleast:")
for name, (covered, count) in sorted(files.items(), key=lambda item: share(*item[1]))[:15]:
    print(f"  {share(covered, count):5.1f} %  {count - covered:4d} lines not  {name}")
