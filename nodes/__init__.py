"""The nodes that come with NEP Studio, each with a manifest beside it."""
