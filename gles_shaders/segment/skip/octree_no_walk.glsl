// Written-out segments look at one node a group.
