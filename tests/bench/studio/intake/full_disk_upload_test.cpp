#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/disks/small_disk.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

/// Hands a file of 3 MB to a studio whose disk of 80 MB fills up on the way. Prints what each piece was
/// answered with, and at the end whether what came is what was sent.
constexpr const char* client = R"(
import hashlib, json, os, pathlib, subprocess, sys, urllib.error, urllib.request

program, folder = sys.argv[1:]
studio = subprocess.Popen([program, "studio", folder], stderr=subprocess.PIPE, text=True)
address = next(word for line in studio.stderr for word in line.split() if word.startswith("http"))
origin, token = address.split("/?token=")

def ask(path, body):
    request = urllib.request.Request(origin + path, body, {"X-Kerf-Token": token, "Origin": origin,
        "Content-Type": "application/json" if body[:1] == b"{" else "application/octet-stream"})
    try:
        return 200, json.load(urllib.request.urlopen(request))
    except urllib.error.HTTPError as error:
        return error.code, json.load(error)

sent = bytes(range(256)) * 12288
begin = json.dumps({"name": "long.txt", "bytes": len(sent), "modified": 1}).encode()
piece = 1 << 18
filler = pathlib.Path(folder) / "filler"
try:
    status, told = ask("/api/import/begin", begin)
    upload, have = told["upload"], told["have"]
    while have < len(sent):
        if have == 4 * piece and not filler.exists():
            with open(filler, "wb") as stream:
                free = os.statvfs(folder)
                stream.write(bytes(free.f_bavail * free.f_frsize - 100_000))
        status, told = ask(f"/api/import/piece?upload={upload}&at={have}", sent[have:have + piece])
        if status == 200:
            have = told["have"]
            continue
        print(status, told["error"])
        filler.unlink()
        filler = pathlib.Path("/dev/null")
        before, have = have, ask("/api/import/begin", begin)[1]["have"]
        print("goes on where it was:", have == before)
    came = next(pathlib.Path(folder).rglob("long.txt"))
    print("the same:", hashlib.sha256(came.read_bytes()).digest() == hashlib.sha256(sent).digest())
finally:
    studio.terminate()
    studio.wait()
)";

TEST(Upload, ToADiskThatFillsUpSaysSoLosesNothingAndGoesOn) {
  if (!test::can_have_small_disk()) GTEST_SKIP() << "no right to mount a disk";
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  test::write_text(folder / "client.py", client);
  const std::string disk = (folder / "disk").string();
  const test::Outcome ran = test::run_on_small_disk(
      disk, 80 << 20U, "python3 '" + (folder / "client.py").string() + "' '" KERF_PROGRAM "' '" + disk + "'");
  EXPECT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output, testing::MatchesRegex("507 [^\n]*long\\.txt[^\n]*disk[^\n]*\n"
                                                "goes on where it was: True\n"
                                                "the same: True\n"));
}

}  // namespace
}  // namespace kerf::bench
