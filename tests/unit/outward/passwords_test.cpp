// Passwords of databases reach no message.
#include <gtest/gtest.h>

#include "pipeline/base/error.h"
#include "pipeline/outward/postgis.h"

namespace blockrand::outward {
namespace {

TEST(Passwords, AreTakenOutOfConnections) {
  EXPECT_EQ(without_password("PG:dbname=city password=se=cret host=db"), "PG:dbname=city password=*** host=db");
  EXPECT_EQ(without_password("PG:dbname=city PASSWORD = 'a b\\' c' host=db"),
            "PG:dbname=city PASSWORD = '***' host=db");
  EXPECT_EQ(without_password("PG:password=x sslpassword=y"), "PG:password=*** sslpassword=***");
  EXPECT_EQ(without_password("postgresql://ann:s3:cr@et@db:5432/city?sslmode=require"),
            "postgresql://ann:***@db:5432/city?sslmode=require");
  EXPECT_EQ(without_password("postgresql://ann:pa?ss@db/city"), "postgresql://ann:***@db/city");
  EXPECT_EQ(without_password("postgresql://ann:pa?ss@db"), "postgresql://ann:***@db");
  EXPECT_EQ(without_password("postgresql://db/city?password=x&user=ann"), "postgresql://db/city?password=***&user=ann");
}

TEST(Passwords, WhatHasNoneStaysAsItIs) {
  for (const std::string connection :
       {"PG:dbname=city host=db", "PG:service=city", "postgresql://ann@db/city",
        "postgresql://db:5432/city?application_name=a@b", "PG:dbname=password_store", "PG:password="})
    EXPECT_EQ(without_password(connection), connection);
}

TEST(Passwords, AreTakenOutOfWhatLibrariesSay) {
  EXPECT_EQ(
      clean_of_passwords("cannot connect with 'dbname=city password=secret': secret", "PG:dbname=city password=secret"),
      "cannot connect with 'dbname=city password=***': ***");
}

TEST(Passwords, HaveNoPlaceInASettingsFile) {
  EXPECT_THROW(refuse_password_in("region.toml", "PG:dbname=city password=x"), base::InputError);
  EXPECT_NO_THROW(refuse_password_in("region.toml", "PG:service=city"));
}

}  // namespace
}  // namespace blockrand::outward
