"""What designs are judged by: objectives, their reductions and the cooling of rooms."""
