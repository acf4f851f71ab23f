echo was here > /tmp/hostile-608
