// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charge_books.hpp"
#include "dem_coupling/particle_faults.hpp"
#include "tests/support/collective_throw.hpp"

#include <gtest/gtest.h>

namespace him {
namespace {

ChargeMovements someMovements()
{
    ChargeMovements moved;
    moved.toWall = {2e-9, -5e-9};
    moved.inserted = 3e-9;
    moved.removed = 1e-9;
    moved.leaked = 0.25e-9;
    moved.breakdown = 0.5e-9;
    return moved;
}

TEST(ChargeBooks, closeWhenEveryMovementHasItsLine)
{
    ChargeBooks books;
    books.open(10e-9, 12e-9);
    books.post(10e-9 + 3e-9 - 1e-9 - 0.25e-9 - 0.5e-9 - (2e-9 - 5e-9), 20e-9, someMovements());
    EXPECT_NEAR(books.relativeClosureError(), 0, 1e-15);
    EXPECT_NO_THROW(stopOnOpenBooks(books));
}

TEST(ChargeBooks, showWhatHasNoLine)
{
    ChargeBooks books;
    books.open(10e-9, 12e-9);
    const double faked = 4e-12;
    books.post(14.25e-9 + faked, 20e-9, someMovements());
    EXPECT_NEAR(books.closureError(), faked, 1e-20);
    EXPECT_NEAR(books.relativeClosureError(), faked / (20e-9 + 11.75e-9), 1e-12);
    std::string text;
    try {
        stopOnOpenBooks(books);
    } catch (const std::runtime_error& error) {
        text = error.what();
    }
    expectContains(text, "the charge books do not close");
    expectContains(text, "to wall 2 -5e-09 C");
}

TEST(ChargeBooks, measureTheErrorAgainstTheLargestChargeThatEverWasThere)
{
    ChargeBooks books;
    books.open(0, 0);
    EXPECT_EQ(books.relativeClosureError(), 0);
    ChargeMovements moved;
    moved.toWall = {-8e-9};
    books.post(8e-9, 8e-9, moved);
    moved.toWall = {0};
    books.post(1e-18, 1e-18, moved);  // nearly discharged: a remainder of rounding is no fault
    EXPECT_NEAR(books.relativeClosureError(), 1e-18 / 16e-9, 1e-20);
}

TEST(ChargeBooks, ofAContinuedRunGoOnFromItsEarlierMovements)
{
    ChargeBooks books;
    ChargeMovements moved = someMovements();
    books.open(-7e-9, 9e-9, moved);
    EXPECT_NEAR(books.relativeClosureError(), 0, 1e-15);
    moved.toWall[0] += 1e-9;
    books.post(-8e-9, 9e-9, moved);
    EXPECT_NEAR(books.relativeClosureError(), 0, 1e-15);
    books.post(-7e-9, 9e-9, moved);
    EXPECT_NEAR(books.closureError(), 1e-9, 1e-22);
}

TEST(ChargeBooks, areNeverOpenWithoutCharge)
{
    ChargeBooks books;
    books.open(0, 0);
    books.post(0, 0, {});
    EXPECT_EQ(books.relativeClosureError(), 0);
}

}  // namespace
}  // namespace him
