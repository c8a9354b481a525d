#include "server/storage/blob_folder.h"

#include <doctest/doctest.h>

#include <fstream>

#include "server/storage/data_directory.h"
#include "server/storage/sqlite_accounts.h"
#include "server/support/crypto.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server {

TEST_SUITE("server/storage/blob_folder") {
    TEST_CASE("what is the same is kept once, and read back as it was") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        const std::string digest = blobs.put("a last");
        CHECK(digest == sha256("a last"));
        CHECK(blobs.put("a last") == digest);
        CHECK(blobs.all() == std::vector<std::string>{digest});
        CHECK(blobs.read(digest) == "a last");
        CHECK(blobs.read(digest, 2, 4) == "last");
        CHECK(blobs.bytes() == 6);
        CHECK_THROWS_AS((void)blobs.read(digest, 2, 5), CorruptBlob);
        CHECK_THROWS_AS((void)blobs.read(sha256("another")), CorruptBlob);
    }

    TEST_CASE("a blob that went bad is noticed, and mended when it comes again") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        const std::string digest = blobs.put("a last");
        std::ofstream(blobs.path_of(digest)) << "a lost";
        CHECK_THROWS_AS((void)blobs.read(digest), CorruptBlob);
        CHECK(blobs.put("a last") == digest);
        CHECK(blobs.read(digest) == "a last");
    }

    TEST_CASE("what a write that was cut off left behind is cleared at the next start") {
        const lastflat::test::TemporaryFolder folder;
        { const BlobFolder blobs(folder.path() / "blobs"); }
        const auto left = folder.path() / "blobs" / "00" / ".new-1-1";
        std::ofstream(left) << "half";
        const BlobFolder blobs(folder.path() / "blobs");
        CHECK_FALSE(std::filesystem::exists(left));
        CHECK(blobs.all().empty());
    }

    TEST_CASE("only what nobody needs is removed") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        const std::string kept = blobs.put("kept"), gone = blobs.put("gone");
        CHECK(blobs.remove_unneeded(
                  {kept, gone}, [&](const std::string& digest) { return digest == kept; }) == 1);
        CHECK(blobs.all() == std::vector<std::string>{kept});
    }

    TEST_CASE("a file is taken over whole") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        write_durably(folder.path() / "result", "a result");
        blobs.adopt(folder.path() / "result", sha256("a result"));
        CHECK(blobs.read(sha256("a result")) == "a result");
        CHECK_THROWS_AS(blobs.adopt(folder.path() / "result", sha256("x")), StoreError);
    }
}

TEST_SUITE("server/storage/blob_folder") {
    TEST_CASE("a blob that is gone or cut is corrupt, and no reason to ask again") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        const std::string digest = blobs.put("a result");
        std::filesystem::resize_file(blobs.path_of(digest), 3);
        CHECK_THROWS_AS((void)blobs.read(digest), CorruptBlob);
        CHECK_THROWS_AS((void)blobs.read(digest, 2, 4), CorruptBlob);
        CHECK(blobs.read(digest, 0, 3) == "a r");
        std::filesystem::remove(blobs.path_of(digest));
        CHECK_THROWS_AS((void)blobs.read(digest), CorruptBlob);
        CHECK_THROWS_AS((void)blobs.read(digest, 0, 1), CorruptBlob);
    }

    TEST_CASE("a folder that takes nothing says so when it is checked") {
        const lastflat::test::TemporaryFolder folder;
        const BlobFolder blobs(folder.path() / "blobs");
        CHECK_NOTHROW(blobs.check());
        CHECK(blobs.all().empty());
        std::filesystem::remove_all(folder.path() / "blobs" / "00");
        CHECK_THROWS_AS(blobs.check(), StoreError);
    }
}

TEST_SUITE("server/storage/data_directory") {
    TEST_CASE("a lost database is not taken for a new one") {
        const lastflat::test::TemporaryFolder folder;
        const auto file = folder.path() / "jobs.sqlite";
        CHECK(sound_database(folder.path()) == file);  // nothing was here
        { SqliteDatabase database(file); }
        mark_database(folder.path(), "its id");
        mark_database(folder.path(), "its id");
        CHECK_THROWS_AS(mark_database(folder.path(), "another"), StoreError);
        CHECK(sound_database(folder.path()) == file);
        std::filesystem::resize_file(file, 0);
        CHECK_THROWS_AS((void)sound_database(folder.path()), StoreError);
        std::filesystem::remove(file);
        CHECK_THROWS_AS((void)sound_database(folder.path()), StoreError);
        std::filesystem::remove(folder.path() / "database");
        CHECK_NOTHROW((void)sound_database(folder.path()));
        (void)BlobFolder(folder.path() / "blobs").put("a model");
        CHECK_THROWS_AS((void)sound_database(folder.path()), StoreError);
    }

    TEST_CASE("a database that is removed or replaced while it is open takes nothing more") {
        const lastflat::test::TemporaryFolder folder;
        const auto file = folder.path() / "jobs.sqlite";
        SqliteDatabase database(file);
        (void)SqliteKeys(database).secret("database");
        CHECK_NOTHROW(database.check());
        const auto elsewhere = folder.path() / "elsewhere";
        std::filesystem::rename(file, elsewhere);
        CHECK_THROWS_AS(database.check(), StoreError);
        CHECK_THROWS_AS((void)SqliteKeys(database).add({"key"}), StoreError);
        std::filesystem::copy_file(elsewhere, file);
        CHECK_THROWS_AS(database.check(), StoreError);
        std::filesystem::rename(elsewhere, file);
        CHECK_NOTHROW(database.check());
    }

    TEST_CASE("the folder is made, and held by one at a time") {
        const lastflat::test::TemporaryFolder folder;
        const auto path = folder.path() / "data";
        {
            const DataDirectory data(path);
            CHECK(std::filesystem::is_directory(data.work()));
            CHECK_THROWS_AS(DataDirectory{path}, StoreError);
            std::ofstream(data.work() / "half a result") << "x";
        }
        const DataDirectory data(path);
        CHECK(std::filesystem::is_empty(data.work()));
    }

    TEST_CASE("a folder that cannot be is said with its name") {
        CHECK_THROWS_WITH_AS(DataDirectory("/dev/null/data"), doctest::Contains("/dev/null/data"),
                             StoreError);
    }
}

TEST_SUITE("server/storage/sqlite_accounts") {
    TEST_CASE("a key is good until it is revoked, and is not in the database") {
        const lastflat::test::TemporaryFolder folder;
        SqliteDatabase database(folder.path() / "jobs.sqlite");
        SqliteKeys keys(database);
        CHECK_FALSE(keys.has_keys());
        const std::string key = keys.add({"factory"});
        CHECK(keys.has_keys());
        const std::string id = keys.check(key)->id;
        CHECK(keys.list().at(0).id == id);
        for (const std::string& wrong :
             {key + "x", key.substr(0, key.size() - 1), std::string(), std::string("lastflat_"),
              "lastflat_" + id + "_" + std::string(64, '0')})
            CHECK_FALSE(keys.check(wrong).has_value());
        std::string bytes;
        for (const char* file : {"jobs.sqlite", "jobs.sqlite-wal"}) {
            std::ifstream in(folder.path() / file, std::ios::binary);
            bytes.append(std::istreambuf_iterator<char>(in), {});
        }
        CHECK(bytes.find(sha256(key)) != std::string::npos);
        CHECK(bytes.find(key) == std::string::npos);
        CHECK(keys.revoke(id));
        CHECK_FALSE(keys.revoke(id));
        CHECK_FALSE(keys.check(key).has_value());
        CHECK(keys.has_keys());  // once closed, never open again
        CHECK(keys.secret("cursor").size() == 64);
        CHECK(keys.secret("cursor") == keys.secret("cursor"));
        CHECK(keys.secret("cursor") != keys.secret("another"));
    }

    TEST_CASE("an asset is its owner's") {
        const lastflat::test::TemporaryFolder folder;
        SqliteDatabase database(folder.path() / "jobs.sqlite");
        SqliteAssets assets(database);
        const AssetLimits limits{10, 2};
        CHECK(assets.add("one", "digest", 7, limits) == AssetAdmission::added);
        CHECK(assets.add("one", "digest", 7, limits) == AssetAdmission::known);
        CHECK(assets.add("one", "too long", 4, limits) == AssetAdmission::full);
        CHECK(assets.add("one", "another", 3, limits) == AssetAdmission::added);
        CHECK(assets.add("one", "a third", 0, limits) == AssetAdmission::full);
        CHECK(assets.add("two", "too long", 4, limits) == AssetAdmission::added);
        CHECK(assets.list("one").size() == 2);
        CHECK(assets.find("one", "digest")->bytes == 7);
        CHECK_FALSE(assets.find("two", "digest").has_value());
        CHECK_FALSE(assets.remove("two", "digest"));
        CHECK(assets.remove("one", "digest"));
    }
}

TEST_SUITE("server/support/crypto") {
    TEST_CASE("digests are those of the standards") {
        // FIPS 180-2, B.1; RFC 4231, test case 2.
        CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        CHECK(hexadecimal(hmac_sha256("Jefe", "what do ya want for nothing?")) ==
              "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
        CHECK(equal_in_constant_time("same", "same"));
        CHECK_FALSE(equal_in_constant_time("same", "Same"));
        CHECK_FALSE(equal_in_constant_time("same", "sam"));
    }
}

}  // namespace lastflat::server
